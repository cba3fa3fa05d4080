//! Several documents as one, for a page of views that were measured apart.

use super::document::{ErrorTime, Point};

impl ErrorTime {
    /// Adds the views of `other`, and scenes, machines and methods that are not here yet. Both must have been checked ([`ErrorTime::check`]).
    ///
    /// # Errors
    /// In words: what was asked for is not the same, a name stands for two things, or a view is in both.
    pub fn join(&mut self, other: Self) -> Result<(), String> {
        if self.options != other.options {
            return Err("measured with other samples, size of errors, shading or display".to_owned());
        }
        let scenes = merged(&mut self.scenes, other.scenes, |a, b| a.name == b.name, |scene| format!("scene {}", scene.name))?;
        let machines = merged(&mut self.machines, other.machines, |a, b| a.title() == b.title(), |of| format!("machine {}", of.title()))?;
        merged(&mut self.methods, other.methods, |a, b| a.name == b.name, |method| format!("method {}", method.name))?;
        let first = self.views.len();
        for mut view in other.views {
            view.scene = scenes[view.scene];
            let same = |of: &&super::ViewEntry| (of.scene, of.eye, of.size) == (view.scene, view.eye, view.size);
            if self.views[..first].iter().any(|of| same(&of)) {
                let name = &self.scenes[view.scene].name;
                return Err(format!("scene {name} from {} radii, {}x{}, is in one before it", view.distance, view.size[0], view.size[1]));
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
        Ok(())
    }
}

/// Adds to `own` what is not in it; where each of `others` stands then. What is alike by name must be alike in all.
fn merged<T: PartialEq>(own: &mut Vec<T>, others: Vec<T>, alike: fn(&T, &T) -> bool, name: fn(&T) -> String) -> Result<Vec<usize>, String> {
    let place = |other: T| match own.iter().position(|one| alike(one, &other)) {
        Some(at) if own[at] == other => Ok(at),
        Some(_) => Err(format!("{} is another than in one before it", name(&other))),
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
    fn what_is_alike_by_name_must_be_alike_in_all() {
        let mut own = vec![("a", 1), ("b", 2)];
        let join = |own: &mut Vec<_>, others| merged(own, others, |a: &(&str, i32), b| a.0 == b.0, |of| format!("thing {}", of.0));
        assert_eq!(join(&mut own, vec![("c", 3), ("a", 1)]), Ok(vec![2, 0]));
        assert_eq!(join(&mut own, vec![("b", 3)]), Err("thing b is another than in one before it".to_owned()));
        assert_eq!(own.len(), 3);
    }
}
