#![no_main]

libfuzzer_sys::fuzz_target!(|text: &str| {
    // What is read may be out of range, but must be reported without a panic.
    let _ = ambray_files::settings_file::parse(text);
});
