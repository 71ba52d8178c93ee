#![no_main]

#[path = "../../src/bin/twelvefold/picture/mod.rs"]
#[allow(dead_code, reason = "the program uses the rest")]
mod picture;
#[path = "../../src/bin/twelvefold/point_list.rs"]
#[allow(dead_code, reason = "the program uses the rest")]
mod point_list;
#[path = "../readers.rs"]
mod readers;

libfuzzer_sys::fuzz_target!(|data: &[u8]| readers::readers(data));
