//! What is asked of a ray.

/// A ray in the world, and what is wanted of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query {
    /// Origin.
    pub origin: [f64; 3],
    /// Direction, any positive length.
    pub direction: [f64; 3],
    /// Radius of its cone at the origin, in world units.
    pub radius: f64,
    /// Tangent of the cone's half angle.
    pub tan_theta: f64,
    /// Nothing nearer counts: a distance from the origin in world units.
    pub t_min: f64,
    /// Nothing farther counts.
    pub t_max: f64,
    /// Any hit serves, not only the closest: the ray ends with the first triangles tested together of which it meets one, and has the closest of these.
    pub any: bool,
    /// The earlier ray, by its number in its source, behind whose end this one starts.
    pub after: Option<u64>,
}

impl Query {
    /// The closest hit of a thin ray, however far.
    pub fn new(origin: [f64; 3], direction: [f64; 3]) -> Self {
        Self { origin, direction, radius: 0.0, tan_theta: 0.0, t_min: 0.0, t_max: f64::INFINITY, any: false, after: None }
    }

    /// The same with a cone of `radius` at the origin that grows by `tan_theta` per unit of length.
    #[must_use]
    pub fn with_cone(self, radius: f64, tan_theta: f64) -> Self {
        Self { radius, tan_theta, ..self }
    }

    /// The same between two distances from the origin.
    #[must_use]
    pub fn between(self, t_min: f64, t_max: f64) -> Self {
        Self { t_min, t_max, ..self }
    }
}
