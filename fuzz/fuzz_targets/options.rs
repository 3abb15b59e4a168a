#![no_main]

libfuzzer_sys::fuzz_target!(|line: &str| {
    let arguments = std::iter::once("ambray").chain(line.split('\n'));
    if let Err(error) = ambray_cli::args::parse_from(arguments) {
        assert!(!error.to_string().is_empty());
    }
});
