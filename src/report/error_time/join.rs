//! Several documents as one, for a page of views that were measured apart.

use super::document::{ErrorTime, MethodEntry, Options, Point};
use serde_json::Value;

impl ErrorTime {
    /// Both: the views of the two, and scenes, machines and methods of each once. A page tells views of a scene by their distance, so no two may have the same.
    ///
    /// # Errors
    /// In words: what was asked for is not the same, a name stands for two things, or a view is in both.
    ///
    /// # Panics
    /// Numbers in `other` name nothing ([`ErrorTime::check`]).
    pub fn join(mut self, other: Self) -> Result<Self, String> {
        if let Some((field, own, theirs)) = differing(&self.options, &other.options) {
            return Err(format!("options.{field} is {theirs}, and {own} in a file before it"));
        }
        let scenes = merged(&mut self.scenes, other.scenes, |scene| format!("scene {}", scene.name), PartialEq::eq)?;
        let machines = merged(&mut self.machines, other.machines, |machine| format!("machine {}", machine.title()), PartialEq::eq)?;
        // What is said of a method changes from version to version.
        let same = |a: &MethodEntry, b: &MethodEntry| (&a.knob, a.in_steps) == (&b.knob, b.in_steps);
        merged(&mut self.methods, other.methods, |method| format!("method {}", method.name), same)?;
        let first = self.views.len();
        for mut view in other.views {
            view.scene = scenes[view.scene];
            if self.views[..first].iter().any(|own| (own.scene, own.distance) == (view.scene, view.distance)) {
                let name = &self.scenes[view.scene].name;
                return Err(format!("scene {name} from {} radii is in a file before it, too", view.distance));
            }
            self.views.push(view);
        }
        if !self.program.split(" and ").any(|program| program == other.program) {
            self.program += &format!(" and {}", other.program);
        }
        let point = |mut point: Point| {
            point.view += first;
            point.costs.iter_mut().for_each(|costs| costs.machine = machines[costs.machine]);
            point
        };
        self.points.extend(other.points.into_iter().map(point));
        self.left_out.extend(other.left_out.into_iter().map(|mut left| {
            left.point = point(left.point);
            left
        }));
        self.sizes.extend(other.sizes.into_iter().map(|mut size| {
            size.view += first;
            size.costs.iter_mut().for_each(|costs| costs.machine = machines[costs.machine]);
            size
        }));
        self.equal_error.extend(other.equal_error.into_iter().map(|mut equal| {
            (equal.view, equal.machine) = (equal.view + first, machines[equal.machine]);
            equal
        }));
        self.pictures.extend(other.pictures.into_iter().map(|mut picture| {
            picture.view += first;
            picture
        }));
        self.traces.extend(other.traces.into_iter().map(|mut grid| {
            grid.view += first;
            grid
        }));
        Ok(self)
    }
}

/// The first option that is not the same, with both values.
fn differing(own: &Options, other: &Options) -> Option<(String, Value, Value)> {
    let [own, other] = [own, other].map(|options| serde_json::to_value(options).unwrap_or_default());
    let fields = own.as_object()?.iter().map(|(field, value)| (field.clone(), value.clone(), other[field].clone()));
    fields.into_iter().find(|(_, own, theirs)| own != theirs)
}

/// Adds to `own` what is not in it; where each of `others` stands then. What has the same name must be the same.
fn merged<T>(own: &mut Vec<T>, others: Vec<T>, name: fn(&T) -> String, same: fn(&T, &T) -> bool) -> Result<Vec<usize>, String> {
    let place = |other: T| match own.iter().position(|one| name(one) == name(&other)) {
        Some(at) if same(&own[at], &other) => Ok(at),
        Some(_) => Err(format!("{} is another than in a file before it", name(&other))),
        None => {
            own.push(other);
            Ok(own.len() - 1)
        }
    };
    others.into_iter().map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_the_same_name_must_be_the_same() {
        let mut own = vec![("a", 1), ("b", 2)];
        let join = |own: &mut Vec<_>, others| merged(own, others, |of: &(&str, i32)| format!("thing {}", of.0), PartialEq::eq);
        assert_eq!(join(&mut own, vec![("c", 3), ("a", 1)]), Ok(vec![2, 0]));
        assert_eq!(join(&mut own, vec![("b", 3)]), Err("thing b is another than in a file before it".to_owned()));
        assert_eq!(own.len(), 3);
    }
}
