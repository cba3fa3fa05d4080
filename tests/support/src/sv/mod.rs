//! As much of SystemVerilog as `rtl/` uses: the package's numbers, structs and enums, and the heads of modules.

mod donts;
mod expression;
mod module;
mod package;
mod tokens;

pub use donts::donts;
pub use module::{Module, Port};
pub use package::{Package, Shape, StructField};

/// What is wrong, with the place it is at.
pub type Result<T> = std::result::Result<T, String>;

/// A text without its comments and its directives on nets.
pub fn code(text: &str) -> String {
    let lines = text.lines().filter(|line| !line.starts_with("`default_nettype"));
    lines.map(|line| line.split("//").next().unwrap_or(line)).collect::<Vec<_>>().join("\n")
}
