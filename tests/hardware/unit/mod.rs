//! The traversal unit without its RTL (that is `rtl_unit`): its cycle model, its timing, and many of it on a machine.

mod early;
mod machine;
mod model;
mod timing;
