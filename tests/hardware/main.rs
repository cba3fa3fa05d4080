//! The hardware as text, as numbers and as a cycle model. Its RTL runs in `rtl`, `rtl_unit` and `rtl_axi`.

mod build_in;
mod mirror;
mod package;
mod refined_netlist;
mod registers;
mod rtl_lint;
mod stated_cycles;
mod unit;
