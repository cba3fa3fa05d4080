//! Where to look from.

/// The paper's camera: focal length 35 on a sensor of height 24.
pub const DEFAULT_VIEW_ANGLE_DEGREES: f64 = 37.849_288_832_102_47;

/// From the target to the eye if nothing says so, where up is +y.
pub const DEFAULT_DIRECTION: [f64; 3] = [0.35, 0.5, 1.0];

/// Where to look from; what is `None` is chosen to suit the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Eye; by default in `direction` from the target.
    pub eye: Option<[f64; 3]>,
    /// From the target to the eye, any length, where `eye` is `None`; by default [`DEFAULT_DIRECTION`], turned with `up`.
    pub direction: Option<[f64; 3]>,
    /// Target; by default the centre of the model's box.
    pub target: Option<[f64; 3]>,
    /// Up; (0, 1, 0) by default.
    pub up: Option<[f64; 3]>,
    /// Distance from target to eye in bounding radii, where `eye` is `None` or only gives the direction; by default the smallest (rounded up to
    /// hundredths) at which the picture holds the whole bounding sphere.
    pub distance: Option<f64>,
    /// Vertical view angle in degrees.
    pub fov: f64,
}

impl Default for View {
    fn default() -> Self {
        Self { eye: None, direction: None, target: None, up: None, distance: None, fov: DEFAULT_VIEW_ANGLE_DEGREES }
    }
}
