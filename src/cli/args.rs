//! Arguments that several subcommands take.

use clap::Args;
use clap::ValueEnum;
use lodray::num::MAX_LEVELS;
use lodray::paths::CameraTable;
use lodray::rays::{Camera, DEFAULT_VIEW_ANGLE_DEGREES, MAX_PIXELS, MAX_SIDE, ModelSpace, View};
use std::fmt::{self, Display};
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A picture size, WIDTHxHEIGHT.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Size(pub u32, pub u32);

impl FromStr for Size {
    type Err = String;
    fn from_str(s: &str) -> Result<Self, String> {
        let sides = s.split_once(['x', 'X']).and_then(|(w, h)| Some([w.parse::<u64>().ok()?, h.parse().ok()?]));
        let [w, h] = sides.ok_or_else(|| format!("'{s}' is not a size such as 1024x768"))?;
        let side = |v: u64| u32::try_from(v).ok().filter(|v| (1..=MAX_SIDE).contains(v));
        match (side(w), side(h)) {
            (Some(w), Some(h)) if u64::from(w) * u64::from(h) <= MAX_PIXELS => Ok(Self(w, h)),
            _ => Err(format!("width and height must be 1 to {MAX_SIDE}, and their product at most {MAX_PIXELS}")),
        }
    }
}

/// Largest coordinate: beyond, squared lengths overflow.
const MAX_COORDINATE: f64 = 1e100;

/// Three numbers, X,Y,Z.
fn three(s: &str) -> Result<Triple, String> {
    let parts: Vec<f64> = s.split(',').map_while(|v| v.trim().parse().ok()).collect();
    match <[f64; 3]>::try_from(parts) {
        Ok(v) if s.split(',').count() == 3 && !v.iter().any(|c| c.is_nan()) => {
            if v.iter().all(|c| c.abs() <= MAX_COORDINATE) {
                Ok(Triple(v))
            } else {
                Err(format!("each coordinate must be from -{MAX_COORDINATE:e} to {MAX_COORDINATE:e}"))
            }
        }
        _ => Err(format!("'{s}' is not three numbers such as 0,1.5,-2")),
    }
}

/// An up direction: the name of an axis, or three numbers.
fn up(s: &str) -> Result<Triple, String> {
    let (sign, axis) = match s.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, s.strip_prefix('+').unwrap_or(s)),
    };
    if let Some(axis) = ["x", "y", "z"].iter().position(|name| axis.eq_ignore_ascii_case(name)) {
        return Ok(Triple(std::array::from_fn(|k| if k == axis { sign } else { 0.0 })));
    }
    let Triple(v) =
        three(s).map_err(|said| if s.contains(',') { said } else { format!("'{s}' is not x, y, z, -x, -y, -z or three numbers") })?;
    // Below, squared lengths vanish.
    if v.iter().any(|c| c.abs() >= 1.0 / MAX_COORDINATE) {
        Ok(Triple(v))
    } else {
        Err(format!("a direction has a length: one coordinate must be {:e} or more, or -{0:e} or less", 1.0 / MAX_COORDINATE))
    }
}

/// Three numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple(pub [f64; 3]);

/// Views by name, as angles around the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum NamedView {
    /// --yaw 0 --pitch 0
    Front,
    /// --yaw 180
    Back,
    /// The same as right
    Side,
    /// --yaw 90
    Right,
    /// --yaw -90
    Left,
    /// --pitch 90, the front at the lower border
    Top,
    /// --pitch -90, the front at the upper border
    Bottom,
    /// --yaw 35 --pitch 25
    ThreeQuarter,
}

impl NamedView {
    /// Yaw and pitch in degrees.
    const fn angles(self) -> (f64, f64) {
        match self {
            Self::Front => (0.0, 0.0),
            Self::Back => (180.0, 0.0),
            Self::Side | Self::Right => (90.0, 0.0),
            Self::Left => (-90.0, 0.0),
            Self::Top => (0.0, 90.0),
            Self::Bottom => (0.0, -90.0),
            Self::ThreeQuarter => (35.0, 25.0),
        }
    }
}

/// Where the camera is.
#[derive(Args, Clone, Debug)]
pub struct CameraArgs {
    /// Picture size in pixels (default: 1024x1024)
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    size: Option<Size>,
    /// Distance from the target in bounding radii (default, unless --eye is given: the picture just holds the whole model)
    #[arg(long, value_name = "RADII", value_parser = radii, allow_hyphen_values = true)]
    pub distance: Option<f64>,
    /// Eye position (with --distance: only the direction from the target)
    #[arg(long, value_name = "X,Y,Z", value_parser = three, allow_hyphen_values = true, conflicts_with_all = ["view", "yaw", "pitch"])]
    eye: Option<Triple>,
    /// Point to look at (default: centre of the model's box)
    #[arg(long, value_name = "X,Y,Z", value_parser = three, allow_hyphen_values = true)]
    target: Option<Triple>,
    /// Up direction: an axis (x, y, z, -x, -y, -z) or three numbers (default: y)
    #[arg(long, value_name = "AXIS|X,Y,Z", value_parser = up, allow_hyphen_values = true)]
    up: Option<Triple>,
    /// View by name, relative to the up axis (default: from the direction 0.35,0.5,1, turned with --up)
    #[arg(long, value_enum, conflicts_with_all = ["yaw", "pitch"])]
    view: Option<NamedView>,
    /// Degrees around the up axis, -360 to 360: 0 is the front (the side of +z; with --up z that of -y), 90 the side of +x (default: 0 if --pitch is given)
    #[arg(long, value_name = "DEGREES", value_parser = degrees, allow_hyphen_values = true)]
    yaw: Option<f64>,
    /// Degrees above the model, -90 to 90: 90 looks straight down, the front at the lower border (default: 0 if --yaw is given)
    #[arg(long, value_name = "DEGREES", value_parser = pitch, allow_hyphen_values = true)]
    pitch: Option<f64>,
    /// Vertical view angle in degrees (default: focal length 35 on a sensor of height 24)
    #[arg(long, value_name = "DEGREES", value_parser = fov, allow_hyphen_values = true)]
    fov: Option<f64>,
}

/// Of a picture, where nothing says it.
const DEFAULT_SIZE: Size = Size(1024, 1024);

impl CameraArgs {
    /// The names of all of them.
    pub fn ids() -> impl IntoIterator<Item = clap::Id> {
        <Self as Args>::augment_args(clap::Command::new("any")).get_arguments().map(|arg| arg.get_id().clone()).collect::<Vec<_>>()
    }

    /// The camera on a model, `distance` overriding the argument.
    pub fn camera(&self, space: &ModelSpace, distance: Option<f64>) -> anyhow::Result<Camera> {
        let plain = |v: Option<Triple>| v.map(|v| v.0);
        let (eye, target, up) = (plain(self.eye), plain(self.target), plain(self.up));
        let view = View { eye, direction: None, target, up, distance: distance.or(self.distance), fov: self.view_angle() };
        let angles = match (self.view, self.yaw, self.pitch) {
            (None, None, None) => None,
            (None, yaw, pitch) => Some((yaw.unwrap_or(0.0), pitch.unwrap_or(0.0))),
            (Some(named), ..) => Some(named.angles()),
        };
        let view = angles.map_or(view, |(yaw, pitch)| view.around(yaw, pitch));
        self.on(&view, space)
    }
}

impl CameraArgs {
    /// The same with the camera and the size of a description where nothing is said. Angles turn the description's camera about its target; `space` holds all models.
    #[must_use]
    pub fn or(&self, own: &CameraTable, [width, height]: [u32; 2], space: &ModelSpace) -> Self {
        let is_turned = self.view.is_some() || self.yaw.is_some() || self.pitch.is_some();
        let way: [f64; 3] = std::array::from_fn(|k| own.eye[k] - own.target[k]);
        let radii = way.iter().map(|v| v * v).sum::<f64>().sqrt() / space.radius();
        Self {
            size: self.size.or(Some(Size(width, height))),
            distance: self.distance.or(is_turned.then_some(radii)),
            eye: self.eye.or((!is_turned).then_some(Triple(own.eye))),
            target: self.target.or(Some(Triple(own.target))),
            up: self.up.or(Some(Triple(own.up))),
            fov: self.fov.or(Some(own.fov)),
            ..self.clone()
        }
    }

    fn view_angle(&self) -> f64 {
        self.fov.unwrap_or(DEFAULT_VIEW_ANGLE_DEGREES)
    }

    fn on(&self, view: &View, space: &ModelSpace) -> anyhow::Result<Camera> {
        let Size(width, height) = self.size.unwrap_or(DEFAULT_SIZE);
        Ok(Camera::new(view, space, width, height)?)
    }

    /// The camera at `eye`, looking at `target`.
    pub fn at(&self, space: &ModelSpace, eye: [f64; 3], target: [f64; 3]) -> anyhow::Result<Camera> {
        let view = View { eye: Some(eye), target: Some(target), up: self.up.map(|up| up.0), fov: self.view_angle(), ..View::default() };
        self.on(&view, space)
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
    number(s, |v| (1e-6..=1e6).contains(&v), "a distance from 1e-6 to 1e6 bounding radii")
}

fn fov(s: &str) -> Result<f64, String> {
    number(s, |v| v > 0.0 && v < 180.0, "between 0 and 180 degrees")
}

/// A turn.
pub fn degrees(s: &str) -> Result<f64, String> {
    number(s, |v| v.abs() <= 360.0, "from -360 to 360 degrees")
}

fn pitch(s: &str) -> Result<f64, String> {
    number(s, |v| v.abs() <= 90.0, "from -90 to 90 degrees")
}

/// A number for which `fits` holds, which `what` says in words.
pub fn number(s: &str, fits: impl Fn(f64) -> bool, what: &str) -> Result<f64, String> {
    s.parse().ok().filter(|&v| fits(v)).ok_or_else(|| format!("'{s}' is not {what}"))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn up_directions() {
        for (text, axis) in [("y", [0.0, 1.0, 0.0]), ("-x", [-1.0, 0.0, 0.0]), ("+Z", [0.0, 0.0, 1.0]), ("1,2,-3", [1.0, 2.0, -3.0])] {
            assert_eq!(up(text), Ok(Triple(axis)));
        }
        for bad in ["0,0,0", "1e-200,0,0", "w", "--z", "", "-", "1,2", "1,nan,2", "inf,0,0"] {
            assert!(up(bad).is_err(), "{bad}");
        }
    }

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
        assert!(fov("40").is_ok() && fov("0").is_err() && fov("180").is_err() && fov("nan").is_err());
        assert!(
            degrees("-360").is_ok() && degrees("361").is_err() && pitch("90").is_ok() && pitch("-91").is_err() && pitch("inf").is_err()
        );
        for good in ["1", "10"] {
            assert!(whole::<u32>(1..=10)(good).is_ok(), "{good}");
        }
        for bad in ["0", "11", "-1", "1.5", "", "two", "99999999999999999999"] {
            assert_eq!(whole::<u32>(1..=10)(bad), Err(format!("'{bad}' is not a whole number from 1 to 10")));
        }
        assert!(seed()("18446744073709551615").is_ok() && seed()("-1").is_err());
    }
}
