//! The tests that need the whole program, in one binary, so that it links only once.

#![expect(clippy::print_stderr, reason = "a test's own words")]
#![expect(
    clippy::disallowed_methods,
    reason = "tests show the paths that they made themselves"
)]

mod alternatives;
mod architecture;
mod assignments;
mod autograder;
mod bad_input;
mod batch;
mod browser;
mod code_hosts;
mod collected;
mod commands;
mod comparing;
mod composed;
mod containment;
mod conversion;
mod conversion_accepted;
mod converted_passes;
mod cycles;
mod dap;
mod debug;
mod derivatives;
mod devices;
mod diagnostics;
mod dialects;
mod docs;
#[cfg(unix)]
mod driver_start;
#[cfg(target_os = "linux")]
mod editors;
mod engines;
mod equivalent_rewrites;
mod estimators;
mod evaluator;
mod evaluator_programs;
mod evasion;
mod exported;
#[cfg(unix)]
mod fair_verdicts;
mod fairness;
mod fault_names;
mod films;
mod formatting;
mod function_tests;
mod fuzzed;
mod generated;
mod glslang;
mod grading;
mod growth;
mod halves;
mod hosted;
mod hostile;
mod hostile_class;
mod interpreted;
mod isf;
mod large_batch;
mod layers;
mod limits;
mod literals;
mod lookups;
mod lsp;
mod machine_code;
mod marches;
mod math;
mod media;
mod metal;
mod miscompiles;
mod neovim;
mod nesting;
mod page;
mod passes;
mod planted_faults;
mod ported;
mod povray;
mod program;
mod projects;
mod random_draws;
mod reduce;
mod references;
mod rendering;
mod repairs;
mod reports;
mod requirements;
mod rules;
mod scene_commands;
mod sharding;
mod similar;
mod snapshots;
mod stress;
mod strict;
mod submissions;
mod terminal;
mod trade;
mod ui;
mod unstable;
mod value_noise;
mod watch;
mod wgpu_modules;
mod wording;
#[cfg(target_os = "linux")]
mod write_faults;

use toyproof_testkit as support;
