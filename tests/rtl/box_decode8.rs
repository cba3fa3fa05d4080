//! Boxes in the frames of nodes of six.

crate::box_decode::frames!(box_decode8, BoxDecode8, 8, 9);
