//! Nothing is left behind: counters, memory of the process, and what the validation layer finds when all is destroyed.

mod common;
#[path = "common/moving.rs"]
mod moving;
#[path = "common/scenes.rs"]
mod scenes;

use std::sync::Arc;

use ambray_core::{
    aov::Aov,
    control::Control,
    settings::{Falloff, NearRadiance, RadianceSource, Settings, Thin, Window},
};
use ambray_scene::animation::{UpdatePolicy, Updates};
use ambray_vulkan::{AccelerationOptions, Context, DeviceOptions, TraceMode, VulkanBackend, VulkanOptions};
use ash::vk;
use common::context;
use scenes::{room, view};

/// Bytes of memory that the process may gain after it has warmed up. Less than one plane of each frame would be more.
const GROWTH: u64 = 8 << 20;

fn open(context: &Arc<Context>, walls: u32, trace: TraceMode) -> VulkanBackend {
    let options = VulkanOptions { trace, ..VulkanOptions::default() };
    VulkanBackend::new(context, &Arc::new(room(walls)), options, &Control::default())
        .unwrap_or_else(|error| panic!("{error}"))
}

fn render(backend: &VulkanBackend, settings: &Settings, width: u32, height: u32) {
    let frame = backend.render(settings, &view(settings, width, height), Control::default());
    let frame = frame.unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(frame.beauty.len(), (width * height) as usize);
    let picture = backend.show(Aov::Depth, settings).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(picture.size(), (width, height));
}

/// Memory of the process that is in use; 0 where the system does not tell.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    let kilobytes = line.and_then(|rest| rest.split_whitespace().next()?.parse::<u64>().ok());
    kilobytes.unwrap_or(0) << 10
}

/// Rounds of something, after which the memory of the process must be what it was after a third of them.
struct Rounds {
    share: u32,
    is_measured: bool,
}

impl Rounds {
    fn run(&self, what: &str, count: u32, mut round: impl FnMut(u32)) {
        let count = count / self.share;
        (0..count / 3).for_each(&mut round);
        let warm = resident();
        (count / 3..count).for_each(&mut round);
        let growth = resident().saturating_sub(warm);
        println!("{count} {what}: {:.1} MiB more than {} MiB", growth as f64 / 1048576.0, warm >> 20);
        assert!(!self.is_measured || growth < GROWTH, "{what}: {growth} bytes more than {warm}");
    }
}

/// Resizes, changes of settings, and scenes.
fn exercise(context: &Arc<Context>, rounds: &Rounds) {
    let base = Settings { spp: 1, ..Settings::default() };
    let empty = context.live();
    let first = open(context, 2, TraceMode::Auto);
    render(&first, &base, 64, 36);
    let full = context.live();
    rounds.run("resizes", 1000, |i| {
        // Up and down, large and small, wide and high.
        let (width, height) = match i % 4 {
            0 => (1 + i % 64, 1 + i % 36),
            1 => (64, 36),
            2 => (1, 1 + i % 9),
            _ => (1 + i % 7, 1),
        };
        render(&first, &base, width, height);
    });
    render(&first, &base, 64, 36);
    assert_eq!(context.live(), full);

    // Each compiles its programs.
    let programs = (0..3).map(|i| Settings {
        falloff: Falloff::ALL[i % Falloff::ALL.len()],
        thin: Thin::ALL[i % Thin::ALL.len()],
        filter: if i % 2 == 0 { Window::Centred } else { Window::Box },
        radiance_source: RadianceSource::ALL[i % RadianceSource::ALL.len()],
        near_radiance: NearRadiance::ALL[i % NearRadiance::ALL.len()],
        ..base.clone()
    });
    let programs: Vec<_> = programs.collect();
    programs.iter().for_each(|settings| render(&first, settings, 9, 9));
    rounds.run("changes of settings", 200, |i| render(&first, &programs[i as usize % programs.len()], 8, 8));
    rounds.run("scenes", 1000, |i| {
        let scene = Arc::new(room(i % 5));
        let backend = first.with_scene(&scene, &Control::default()).unwrap_or_else(|error| panic!("{error}"));
        if i % 3 == 0 {
            render(&backend, &programs[i as usize / 3 % programs.len()], 16, 9);
        }
    });
    drop(first);
    assert_eq!(context.live(), empty);
    exercise_poses(context, rounds);
    assert_eq!(context.live(), empty);
}

/// Poses under all policies, with frames between.
fn exercise_poses(context: &Arc<Context>, rounds: &Rounds) {
    let settings = Settings { spp: 1, ..Settings::default() };
    let scene = Arc::new(moving::scene(6));
    for policy in [UpdatePolicy::Auto, UpdatePolicy::Cache] {
        let updates = Updates { policy, poses: 2, ..Updates::default() };
        let acceleration = AccelerationOptions { updates, ..AccelerationOptions::default() };
        let options = VulkanOptions { acceleration, ..VulkanOptions::default() };
        let mut backend = VulkanBackend::new(context, &scene, options, &Control::default())
            .unwrap_or_else(|error| panic!("{error}"));
        let mut random = moving::Random(1);
        let mut live = None;
        rounds.run("poses", 500, |i| {
            let pose = moving::pose(&scene, &mut random, (i % 3) as f32);
            let [placed, _] = moving::posed(&scene, &pose);
            let moved = backend.pose(&placed, &pose, &Control::default());
            moved.unwrap_or_else(|error| panic!("{error}"));
            if i % 5 == 0 {
                render(&backend, &settings, 16, 9);
            }
            // By then the cache is full.
            if i > 50 {
                let now = context.live();
                assert_eq!(*live.get_or_insert(now), now, "{policy:?}");
            }
        });
    }
}

/// One test, since tests of one process share its memory. The validation layer has memory of its own, which grows: what is
/// measured is without it.
#[test]
fn nothing_is_left_behind() {
    let Some(watched) = context() else { return };
    let options = DeviceOptions { device: None, software: true, validation: false };
    let unwatched = Context::new(&options).unwrap_or_else(|error| panic!("{error}"));
    exercise(&unwatched, &Rounds { share: 1, is_measured: true });
    drop(unwatched);
    let log = watched.validation_log();
    exercise(&watched, &Rounds { share: 5, is_measured: false });
    drop(watched);
    assert_eq!(log.messages(), [""; 0]);
}

/// That silence above means something.
#[test]
fn what_is_left_behind_is_noticed() {
    let Some(context) = context() else { return };
    let log = context.validation_log();
    let info = vk::BufferCreateInfo::default().size(16).usage(vk::BufferUsageFlags::TRANSFER_SRC);
    // SAFETY: the description lives until the call returns; never to destroy the buffer is what is tested.
    let forgotten = unsafe { context.device().create_buffer(&info, None) };
    forgotten.expect("a buffer");
    assert_eq!(log.messages(), [""; 0]);
    drop(context);
    let messages = log.messages();
    assert!(messages.iter().any(|message| message.contains("VkBuffer")), "{messages:?}");
}
