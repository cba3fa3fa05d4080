//! The order of six children.

crate::child_sort::sorts!(child_sort6, ChildSort6, 6);
