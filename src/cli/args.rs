//! Arguments that several subcommands take.

use clap::Args;
use clap::ValueEnum;
use lodray::bvh;
use lodray::render::{Camera, DEFAULT_VIEW_ANGLE_DEGREES, View};
use lodray::traverse::ModelSpace;
use std::str::FromStr;

/// A picture size, WIDTHxHEIGHT.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size(pub u32, pub u32);

impl FromStr for Size {
    type Err = String;
    fn from_str(s: &str) -> Result<Self, String> {
        let wrong = || format!("'{s}' is not a size such as 1024x768");
        let (w, h) = s.split_once(['x', 'X']).ok_or_else(wrong)?;
        let side = |v: &str| v.parse::<u32>().ok().filter(|v| (1..=65536).contains(v)).ok_or_else(wrong);
        Ok(Self(side(w)?, side(h)?))
    }
}

/// Three numbers, X,Y,Z.
fn three(s: &str) -> Result<Triple, String> {
    let parts: Vec<f64> = s.split(',').map_while(|v| v.trim().parse().ok()).collect();
    match <[f64; 3]>::try_from(parts) {
        Ok(v) if s.split(',').count() == 3 => Ok(Triple(v)),
        _ => Err(format!("'{s}' is not three numbers such as 0,1.5,-2")),
    }
}

/// Three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple(pub [f64; 3]);

/// Where the camera is.
#[derive(Args, Clone, Debug)]
pub struct CameraArgs {
    /// Picture size in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x1024")]
    pub size: Size,
    /// Distance from the target in bounding radii (default 2 unless --eye is given)
    #[arg(long, value_name = "RADII", allow_negative_numbers = true)]
    pub distance: Option<f64>,
    /// Eye position (with --distance: only the direction from the target)
    #[arg(long, value_name = "X,Y,Z", value_parser = three, allow_hyphen_values = true)]
    eye: Option<Triple>,
    /// Point to look at (default: centre of the model's box)
    #[arg(long, value_name = "X,Y,Z", value_parser = three, allow_hyphen_values = true)]
    target: Option<Triple>,
    /// Up direction (default 0,1,0)
    #[arg(long, value_name = "X,Y,Z", value_parser = three, allow_hyphen_values = true)]
    up: Option<Triple>,
    /// Vertical view angle in degrees (default: focal length 35 on a sensor of height 24)
    #[arg(long, value_name = "DEGREES", default_value_t = DEFAULT_VIEW_ANGLE_DEGREES, hide_default_value = true, allow_negative_numbers = true)]
    fov: f64,
}

impl CameraArgs {
    /// The camera on a model, `distance` overriding the argument.
    pub fn camera(&self, space: &ModelSpace, distance: Option<f64>) -> anyhow::Result<Camera> {
        let plain = |v: Option<Triple>| v.map(|v| v.0);
        let view = View {
            eye: plain(self.eye),
            target: plain(self.target),
            up: plain(self.up),
            distance: distance.or(self.distance),
            fov: self.fov,
        };
        Ok(Camera::new(&view, space, self.size.0, self.size.1)?)
    }
}

/// LOD quality: a non-negative number or `inf`.
pub fn delta(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if v >= 0.0 => Ok(v),
        _ => Err(format!("'{s}' is not a quality: 0 (base mesh) to inf (full detail), 1 is one pixel")),
    }
}

/// Leaf layouts by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LeafLayout {
    /// Index triples and shared vertices
    Indexed,
    /// Nine 32-bit coordinates, 36 bytes
    Packed,
    /// One 32-byte line of 28-bit coordinates
    Line,
}

impl From<LeafLayout> for bvh::LeafLayout {
    fn from(layout: LeafLayout) -> Self {
        match layout {
            LeafLayout::Indexed => Self::Indexed,
            LeafLayout::Packed => Self::Packed,
            LeafLayout::Line => Self::Line,
        }
    }
}

/// How the triangles of a full-resolution BVH lie in memory.
#[derive(Args, Clone, Copy, Debug)]
pub struct LeafArgs {
    /// Leaf layout of the full-resolution BVH
    #[arg(long, value_enum, default_value_t = LeafLayout::Line)]
    pub leaf_layout: LeafLayout,
    /// Largest number of triangles in a leaf: 1, 2 or 4
    #[arg(long, default_value_t = 4, value_parser = leaf_size)]
    pub leaf_size: u32,
}

fn leaf_size(s: &str) -> Result<u32, String> {
    match s {
        "1" | "2" | "4" => Ok(u32::from(s.as_bytes()[0] - b'0')),
        _ => Err(format!("'{s}' is not 1, 2 or 4")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_triples() {
        assert_eq!("640x480".parse(), Ok(Size(640, 480)));
        for bad in ["640", "0x3", "ax3", "70000x2", "-1x4", ""] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
        assert_eq!(three("1,-2, 3.5"), Ok(Triple([1.0, -2.0, 3.5])));
        assert!(three("1,2").is_err() && three("1,2,3,4").is_err() && three("1,b,3").is_err());
        assert!(delta("inf").is_ok() && delta("-1").is_err() && delta("nan").is_err());
    }
}
