#![no_main]

mod loading;

libfuzzer_sys::fuzz_target!(|content: &[u8]| loading::load(content, "obj"));
