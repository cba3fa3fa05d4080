//! Arguments that several subcommands take.

use clap::Args;
use clap::ValueEnum;
use lodray::bvh;
use lodray::num::MAX_LEVELS;
use lodray::render::{Camera, DEFAULT_DISTANCE, DEFAULT_VIEW_ANGLE_DEGREES, View};
use lodray::traverse::ModelSpace;
use serde::{Deserialize, Serialize};
use std::fmt::{self, Display};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Most pixels of a picture: traced pixels and their shading then stay below 8 GB.
const MAX_PIXELS: u64 = 1 << 26;

/// A picture size, WIDTHxHEIGHT.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size(pub u32, pub u32);

impl FromStr for Size {
    type Err = String;
    fn from_str(s: &str) -> Result<Self, String> {
        let wrong = || format!("'{s}' is not a size such as 1024x768");
        let (w, h) = s.split_once(['x', 'X']).ok_or_else(wrong)?;
        let side = |v: &str| v.parse::<u32>().ok().filter(|v| (1..=65536).contains(v)).ok_or_else(wrong);
        let (w, h) = (side(w)?, side(h)?);
        if u64::from(w) * u64::from(h) > MAX_PIXELS {
            return Err(format!("'{s}' is more than {MAX_PIXELS} pixels"));
        }
        Ok(Self(w, h))
    }
}

/// Three numbers, X,Y,Z.
fn three(s: &str) -> Result<Triple, String> {
    let parts: Vec<f64> = s.split(',').map_while(|v| v.trim().parse().ok()).collect();
    match <[f64; 3]>::try_from(parts) {
        // Beyond 1e100 squared lengths overflow; NaN fails the comparison too.
        Ok(v) if s.split(',').count() == 3 && v.iter().all(|c| c.abs() <= 1e100) => Ok(Triple(v)),
        _ => Err(format!("'{s}' is not three finite numbers such as 0,1.5,-2")),
    }
}

/// Three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple(pub [f64; 3]);

/// Where the camera is.
#[derive(Args, Clone, Debug)]
pub struct CameraArgs {
    /// Picture size in pixels
    #[arg(long, value_name = "WxH", default_value = "1024x1024", allow_hyphen_values = true)]
    pub size: Size,
    /// Distance from the target in bounding radii (default 2 unless --eye is given)
    #[arg(long, value_name = "RADII", value_parser = radii, allow_hyphen_values = true)]
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
    #[arg(long, value_name = "DEGREES", default_value_t = DEFAULT_VIEW_ANGLE_DEGREES, hide_default_value = true, value_parser = angle, allow_hyphen_values = true)]
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

    /// The distance at which [`CameraArgs::camera`] places the eye; none if it is at a position of its own.
    pub fn radii(&self) -> Option<f64> {
        self.distance.or_else(|| self.eye.is_none().then_some(DEFAULT_DISTANCE))
    }
}

/// How rays find their hits on a simulated machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SimMethod {
    /// Locally adaptive level of detail
    Lod,
    /// Quad-BVH of the full-resolution mesh, 16-bit boxes
    Bvh,
    /// The same with 32-bit boxes
    Bvh32,
}

impl SimMethod {
    /// Its name in options and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lod => "lod",
            Self::Bvh => "bvh",
            Self::Bvh32 => "bvh32",
        }
    }
}

/// A change of a machine, KEY=VALUE.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// The key, dotted.
    pub key: String,
    /// Its value.
    pub value: String,
}

impl FromStr for Change {
    type Err = String;
    fn from_str(s: &str) -> Result<Self, String> {
        let parts = s.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
        let (key, value) =
            parts.filter(|(key, _)| !key.is_empty()).ok_or_else(|| format!("'{s}' is not a change such as l1.bytes=32768"))?;
        Ok(Self { key: key.to_owned(), value: value.to_owned() })
    }
}

impl Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.key, self.value)
    }
}

/// A distance in bounding radii, within what a picture can show anything of.
pub fn radii(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if (1e-6..=1e6).contains(&v) => Ok(v),
        _ => Err(format!("'{s}' is not a distance between 1e-6 and 1e6 bounding radii")),
    }
}

/// A view angle.
fn angle(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if v > 0.0 && v < 180.0 => Ok(v),
        _ => Err(format!("'{s}' is not between 0 and 180 degrees")),
    }
}

/// LOD quality: a non-negative number or `inf`.
pub fn delta(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if v >= 0.0 => Ok(v),
        _ => Err(format!("'{s}' is not a quality: 0 (base mesh) to inf (full detail), 1 is one pixel")),
    }
}

/// A whole number within limits, which the refusal names.
pub fn whole<T: TryFrom<u64>>(limits: RangeInclusive<u64>) -> impl Fn(&str) -> Result<T, String> + Clone {
    move |s| {
        let value = s.parse().ok().filter(|value| limits.contains(value)).and_then(|value| T::try_from(value).ok());
        value.ok_or_else(|| format!("'{s}' is not a whole number from {} to {}", limits.start(), limits.end()))
    }
}

/// Most rays or steps of a command: years of work, and sums of them stay far within 64 bits.
pub const MAX_RAYS: u64 = 1_000_000_000_000_000;

/// Seeds: every 64-bit number is one.
pub fn seed() -> impl Fn(&str) -> Result<u64, String> + Clone {
    whole(0..=u64::MAX)
}

/// Numbers of splits.
pub fn levels() -> impl Fn(&str) -> Result<u32, String> + Clone {
    whole(0..=u64::from(MAX_LEVELS))
}

/// Leaf layouts by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
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

impl LeafLayout {
    /// Its name in options and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Indexed => "indexed",
            Self::Packed => "packed",
            Self::Line => "line",
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
        for bad in ["640", "0x3", "ax3", "70000x2", "65536x65536", "-1x4", ""] {
            assert!(bad.parse::<Size>().is_err(), "{bad}");
        }
        assert_eq!(three("1,-2, 3.5"), Ok(Triple([1.0, -2.0, 3.5])));
        assert!(
            three("1,2").is_err()
                && three("1,2,3,4").is_err()
                && three("1,b,3").is_err()
                && three("1,nan,3").is_err()
                && three("1,1e300,3").is_err()
        );
        assert!(radii("0.5").is_ok() && radii("0").is_err() && radii("-1").is_err() && radii("nan").is_err() && radii("1e300").is_err());
        assert!(angle("40").is_ok() && angle("0").is_err() && angle("180").is_err() && angle("nan").is_err());
        for good in ["1", "10"] {
            assert!(whole::<u32>(1..=10)(good).is_ok(), "{good}");
        }
        for bad in ["0", "11", "-1", "1.5", "", "two", "99999999999999999999"] {
            assert_eq!(whole::<u32>(1..=10)(bad), Err(format!("'{bad}' is not a whole number from 1 to 10")));
        }
        assert!(seed()("18446744073709551615").is_ok() && seed()("-1").is_err());
        assert!(delta("inf").is_ok() && delta("-1").is_err() && delta("nan").is_err());
    }
}
