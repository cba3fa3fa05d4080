//! Transaction-level testbench.
