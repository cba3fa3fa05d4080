//! As much of SystemVerilog as `rtl/` uses for the heads of its modules.

mod donts;
mod module;

pub use donts::donts;
pub use module::{Module, Port};

/// What is wrong, with the place it is at.
pub type Result<T> = std::result::Result<T, String>;

/// A text without its comments and its directives on nets.
pub fn code(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("`default_nettype"));
    lines.map(|line| line.split("//").next().unwrap_or(line)).collect::<Vec<_>>().join("\n")
}
