//! Small models, surfaces and rays for the tests and benchmarks of lodray, a reader of the RTL's declarations, and the program as tests run it.
#![allow(missing_docs)] // the names say what is made

pub mod bounces;
pub mod early;
pub mod hardware;
pub mod hostile;
pub mod house;
pub mod models;
pub mod plain;
pub mod program;
pub mod rust;
pub mod slabs;
pub mod surfaces;
pub mod sv;
pub mod thin;
pub mod timing;

/// Whether `scripts/nightly` asks (`LODRAY_NIGHTLY`), where tests that take long have their full sizes.
pub fn is_nightly() -> bool {
    std::env::var_os("LODRAY_NIGHTLY").is_some()
}

/// `count` cases; what ever failed is kept in a file of the same name beside the test's source, to be committed and tried first.
pub fn cases(count: u32) -> proptest::test_runner::Config {
    use proptest::test_runner::{Config, FileFailurePersistence};
    Config { failure_persistence: Some(Box::new(FileFailurePersistence::WithSource("regressions"))), ..Config::with_cases(count) }
}
