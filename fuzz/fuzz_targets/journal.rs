#![no_main]

#[path = "../../tests/hostile_input_is_refused/targets/mod.rs"]
mod targets;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| targets::run("journal", bytes));
