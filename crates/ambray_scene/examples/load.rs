//! Loads scenes and says what is in them, how long it took and what there was to complain about.

use std::path::PathBuf;
use std::time::Instant;

use ambray_scene::load;

fn main() {
    for path in std::env::args_os().skip(1).map(PathBuf::from) {
        let start = Instant::now();
        match load(&path) {
            Ok(loaded) => {
                let (scene, seconds) = (&loaded.scene, start.elapsed().as_secs_f64());
                println!(
                    "{}: {} triangles, {} instances, {} images in {seconds:.2} s",
                    scene.name,
                    scene.triangle_count(),
                    scene.instances.len(),
                    scene.images.len()
                );
                loaded.warnings.iter().for_each(|warning| println!("  warning: {warning}"));
            }
            Err(error) => println!("error: {error}"),
        }
    }
}
