//! Any bytes as a shader. A panic, an overflow of the stack and a time out of proportion are findings; what naga makes of it is told.

#![no_main]

mod texts;

use libfuzzer_sys::fuzz_target;

fuzz_target!(init: texts::spare_naga(), |text: &str| {
    texts::run(text);
});
