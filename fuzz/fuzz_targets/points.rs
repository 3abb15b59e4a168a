#![no_main]

use ambray_cli::points::Reader;

libfuzzer_sys::fuzz_target!(|content: &[u8]| {
    let mut reader = Reader::new(content, "points", None);
    while let Ok(chunk) = reader.next_chunk(64) {
        if chunk.is_empty() {
            break;
        }
    }
});
