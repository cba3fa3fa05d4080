//! Which results can stand side by side.

/// Checksum of the pinned frames; `scripts/pin` writes it with them.
const PINNED_FRAMES: &str = include_str!("../../tests/pinned/checksum");

/// The version of the program's results: that of the package, and a checksum of the pinned frames (`tests/pinned`), in which every figure of a frame stands.
/// No change of a figure is without a new one, as the test of the pins would fail.
pub fn results_version() -> String {
    format!("{}-{}", env!("CARGO_PKG_VERSION"), PINNED_FRAMES.trim_end())
}
