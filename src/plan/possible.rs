//! Whether a plan that somebody else may have written is one that this program can take.

use super::needs::ALL_ZEROS;
use super::{Plan, Speed, Within, numbers};
use crate::format::{JobRegion, JobView};
use crate::hardware::MOST_INDEX_BITS;
use crate::method::STACK_ENTRIES;
use crate::num::{
    BOX_SHIFT, BoundCode, Direction, Displacement, MAX_BVH_DEPTH, MAX_DISPLACEMENT_SHIFT, MAX_LEVELS, MOST_DIRECTION_ZEROS, Point, U, Vec3,
    Wire,
};
use std::collections::BTreeMap;
use std::fmt::Display;
use thiserror::Error;

/// A field of a plan that cannot be: which, what it must be, and what it is.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct Impossible(String);

/// `field` must be `rule`.
fn must(field: &str, holds: bool, rule: &str, value: impl Display) -> Result<(), Impossible> {
    if holds { Ok(()) } else { Err(Impossible(format!("{field} must be {rule}, but is {value}"))) }
}

fn at_most(field: &str, value: u32, most: u32) -> Result<(), Impossible> {
    must(field, value <= most, &format!("0 to {most}"), value)
}

/// Each number of a table of the file is at most what `limits` has for it.
fn within(table: &str, numbers: &BTreeMap<String, u64>, limits: &[(&str, u32)]) -> Result<(), Impossible> {
    let value = |name: &str| numbers.get(name).copied().unwrap_or(0);
    limits.iter().try_for_each(|&(name, most)| {
        must(&format!("{table}.{name}"), value(name) <= u64::from(most), &format!("0 to {most}"), value(name))
    })
}

/// The numbers of a version, major first.
fn version(text: &str) -> Option<[u64; 3]> {
    let numbers = text.split('.').map(|part| part.parse().ok()).collect::<Option<Vec<_>>>()?;
    numbers.try_into().ok()
}

/// Bits of a component.
const fn component<T: Wire>() -> u32 {
    T::WIDTH / 3
}

/// Bits of the number of a line of a scene: five sections of 2^28 lines at most, two lines a record.
const LINE_BITS: u32 = MOST_INDEX_BITS + 3;

/// The largest values of the fields of [`SceneNeeds`](super::SceneNeeds), by name: those of the formats that they are measured on. Flags are 0 or 1.
const SCENE: [(&str, u32); 23] = [
    ("levels", MAX_LEVELS),
    ("stored-levels", MAX_LEVELS),
    ("bvh-depth", MAX_BVH_DEPTH),
    ("stack-entries", STACK_ENTRIES as u32),
    ("bvh-node-bits", MOST_INDEX_BITS),
    ("tree-bits", MOST_INDEX_BITS),
    ("line-bits", LINE_BITS),
    ("coordinate-bits", component::<Point>()),
    ("frame-bits", component::<Vec3<16>>()),
    ("node-plane-bits", 5),
    ("node-exponent", 15),
    ("split-plane-bits", 2),
    ("split-exponent", 15),
    ("half-steps", 1),
    ("code-bits", BoundCode::WIDTH),
    ("bound-bits", 34),
    ("compact", 1),
    ("exact", 1),
    ("displacement-bits", component::<Displacement>()),
    ("displacement-shift", MAX_DISPLACEMENT_SHIFT),
    ("coordinate-zeros", BOX_SHIFT),
    ("vertex-zeros", ALL_ZEROS),
    ("direction-zeros", MOST_DIRECTION_ZEROS),
];

/// Those of [`RayNeeds`](super::RayNeeds).
const RAYS: [(&str, u32); 10] = [
    ("deepest-level", MAX_LEVELS),
    ("lod-test", 1),
    ("hit-mapping", 1),
    ("start-radius", 1),
    ("origin-bits", component::<Point>()),
    ("direction-bits", component::<Direction>()),
    ("cone-offset-bits", U::<53>::WIDTH),
    ("cone-slope-bits", U::<18>::WIDTH),
    ("cone-shift", 63),
    ("direction-zeros", ALL_ZEROS),
];

impl Plan {
    /// Checks every number against what the formats, the rays and the units of this program can have.
    ///
    /// # Errors
    /// The first field that cannot be, by its name in the file; views and regions are counted from 0.
    pub fn possible(&self) -> Result<(), Impossible> {
        let own = env!("CARGO_PKG_VERSION");
        let known = version(&self.program).is_some_and(|plan| Some(plan) <= version(own));
        must("program", known, &format!("a version up to {own}, this program's"), &self.program)?;
        must("scenes", !self.scenes.is_empty(), "the names of one scene or more", "empty")?;
        within("scene", &numbers(&self.scene), &SCENE)?;
        if let Some(rays) = &self.rays {
            within("rays", &numbers(rays), &RAYS)?;
        }
        if let Some(Within { pixels, coordinate_zeros, direction_zeros }) = self.within {
            must("within.pixels", pixels > 0.0 && pixels.is_finite(), "a finite number above 0", pixels)?;
            at_most("within.coordinate-zeros", coordinate_zeros, BOX_SHIFT)?;
            at_most("within.direction-zeros", direction_zeros, MOST_DIRECTION_ZEROS)?;
        }
        self.speed.as_ref().map_or(Ok(()), possible_speed)?;
        each("views", &self.views, JobView::wrong)?;
        each("regions", &self.regions, JobRegion::wrong)
    }
}

/// Shares are shares, and a machine can have the units.
fn possible_speed(speed: &Speed) -> Result<(), Impossible> {
    must("speed.share", speed.share > 0.0 && speed.share <= 1.0, "above 0 and at most 1", speed.share)?;
    for (field, kept) in [("speed.kept", speed.kept), ("speed.kept-of-memory", speed.kept_of_memory)] {
        must(field, kept >= 0.0 && kept.is_finite(), "a finite number from 0 on", kept)?;
    }
    let units = [("speed.units", &speed.units), ("speed.own", &speed.own)];
    units.into_iter().try_for_each(|(at, units)| units.validate(at).map_err(|breach| Impossible(breach.to_string())))
}

/// Every view or region of every scene can be.
fn each<T>(
    table: &str,
    of: &BTreeMap<String, Vec<T>>,
    wrong: impl Fn(&T) -> Option<(&'static str, &'static str)>,
) -> Result<(), Impossible> {
    for (name, list) in of {
        for (number, item) in list.iter().enumerate() {
            if let Some((field, rule)) = wrong(item) {
                return Err(Impossible(format!("{table}.{name}[{number}].{field} must be {rule}")));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{RayNeeds, SceneNeeds};

    /// Limits are there for every field, so that none goes by unseen.
    #[test]
    fn every_field_has_a_limit() {
        let names = |limits: &[(&str, u32)]| limits.iter().map(|(name, _)| (*name).to_owned()).collect::<std::collections::BTreeSet<_>>();
        assert_eq!(names(&SCENE), numbers(&SceneNeeds::default()).into_keys().collect());
        assert_eq!(names(&RAYS), numbers(&RayNeeds::default()).into_keys().collect());
    }

    /// A plan as `lodray plan --job` writes it, with a region too.
    fn plan() -> serde_json::Value {
        let mut plan = Plan::new(true);
        let needs = SceneNeeds { levels: 3, stored_levels: 3, coordinate_zeros: 0, direction_zeros: 0, ..SceneNeeds::default() };
        plan.add("ball", &needs);
        plan.add_rays(&RayNeeds { deepest_level: 2, ..RayNeeds::default() });
        let view = JobView {
            size: [4, 3],
            delta: "1".into(),
            eye: [0.0, 0.0, 5.0],
            forward: [0.0, 0.0, -1.0],
            right: [0.01, 0.0, 0.0],
            above: [0.0, 0.01, 0.0],
            shift: [0.0; 2],
            cone: 0.005,
        };
        plan.add_view("ball", view);
        plan.add_region("ball", JobRegion { delta: "inf".into(), lo: [-1.0; 3], hi: [1.0; 3], cone: 0.0 });
        plan.coarsen(Within { pixels: 0.5, coordinate_zeros: 3, direction_zeros: 2 });
        serde_json::to_value(plan).expect("a plan")
    }

    /// JSON has no numbers that are none: they are put in afterwards.
    fn with(change: impl FnOnce(&mut Plan)) -> Result<(), Impossible> {
        let mut plan: Plan = serde_json::from_value(plan()).expect("a plan");
        change(&mut plan);
        plan.possible()
    }

    #[test]
    fn what_plan_writes_is_possible() {
        assert_eq!(with(|_| ()), Ok(()));
        assert_eq!(with(|plan| plan.rays = None), Ok(()));
    }

    #[test]
    fn numbers_that_cannot_be_are_refused_by_name() {
        let numbers: [(&str, &str, u64); 16] = [
            ("scene", "levels", 99),
            ("scene", "levels", 11),
            ("scene", "stored-levels", 11),
            ("scene", "coordinate-bits", 64),
            ("scene", "bvh-depth", 25),
            ("scene", "stack-entries", 1000),
            ("scene", "tree-bits", 29),
            ("scene", "code-bits", 9),
            ("scene", "displacement-bits", 14),
            ("scene", "coordinate-zeros", 40),
            ("rays", "deepest-level", 11),
            ("rays", "origin-bits", 33),
            ("rays", "direction-bits", 64),
            ("rays", "cone-shift", 64),
            ("within", "coordinate-zeros", 17),
            ("within", "direction-zeros", 15),
        ];
        for (table, field, value) in numbers {
            let mut text = plan();
            text[table][field] = value.into();
            let plan: Plan = serde_json::from_value(text).expect("a plan");
            let error = plan.possible().expect_err("impossible").to_string();
            assert!(error.starts_with(&format!("{table}.{field} must be ")), "{table}.{field} = {value}: {error}");
        }
    }

    #[test]
    fn views_and_regions_that_no_rays_come_from_are_refused_by_name() {
        type Change = fn(&mut JobView);
        let views: [(&str, Change); 20] = [
            ("size", |view| view.size = [0, 4]),
            ("delta", |view| view.delta = "nan".into()),
            ("delta", |view| view.delta = "-1".into()),
            ("delta", |view| view.delta = "-inf".into()),
            ("delta", |view| view.delta = "fine".into()),
            ("eye", |view| view.eye[0] = f64::NAN),
            ("eye", |view| view.eye[2] = f64::INFINITY),
            ("forward", |view| view.forward = [0.0; 3]),
            ("forward", |view| view.forward[2] = -1.1),
            ("forward", |view| view.forward[1] = f64::NAN),
            ("right", |view| view.right = [0.0; 3]),
            ("right", |view| view.right[0] = f64::NAN),
            ("right", |view| view.right = [0.01, 0.0, 0.01]),
            ("above", |view| view.above = [0.01, 0.0, 0.0]),
            ("above", |view| view.above[1] = f64::INFINITY),
            ("shift", |view| view.shift[0] = f64::NAN),
            ("shift", |view| view.shift[1] = f64::NEG_INFINITY),
            ("cone", |view| view.cone = -1.0),
            ("cone", |view| view.cone = f64::INFINITY),
            ("cone", |view| view.cone = f64::NAN),
        ];
        for (field, change) in views {
            let error = with(|plan| change(&mut plan.views.get_mut("ball").expect("views")[0])).expect_err(field).to_string();
            assert!(error.starts_with(&format!("views.ball[0].{field} must be ")), "{error}");
        }
        let region = with(|plan| plan.regions.get_mut("ball").expect("regions")[0].cone = f64::NAN).expect_err("cone").to_string();
        assert!(region.starts_with("regions.ball[0].cone must be "), "{region}");
        for pixels in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(with(|plan| plan.within.as_mut().expect("grids").pixels = pixels).is_err(), "{pixels}");
        }
    }

    #[test]
    fn plans_of_later_programs_are_refused() {
        for (program, is_known) in [(env!("CARGO_PKG_VERSION"), true), ("0.0.9", true), ("9.0.0", false), ("0.1", false), ("", false)] {
            assert_eq!(with(|plan| plan.program = program.to_owned()).is_ok(), is_known, "{program}");
        }
        assert!(with(|plan| plan.scenes.clear()).is_err());
    }
}
