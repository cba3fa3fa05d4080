//! Whether a document's numbers of views, scenes and machines are of its own.

use super::document::{ErrorTime, VERSION};

impl ErrorTime {
    /// Every number names something.
    ///
    /// # Errors
    /// The first field that does not, in words.
    pub fn check(&self) -> Result<(), String> {
        if self.version != VERSION {
            return Err(format!("version is {}, and this program reads {VERSION}", self.version));
        }
        let names = |field: String, number: usize, of: &str, count: usize| {
            if number < count { Ok(()) } else { Err(format!("{field} is {number}, and there are {count} {of}")) }
        };
        let (scenes, machines, views) = (self.scenes.len(), self.machines.len(), self.views.len());
        for (k, view) in self.views.iter().enumerate() {
            names(format!("views[{k}].scene"), view.scene, "scenes", scenes)?;
            if !(view.distance > 0.0 && view.distance.is_finite()) || view.size.contains(&0) || view.every == 0 {
                return Err(format!("views[{k}]: distance, size and every must be above 0"));
            }
        }
        let points = self.points.iter().enumerate().map(|(k, point)| (format!("points[{k}]"), point));
        let left = self.left_out.iter().enumerate().map(|(k, left)| (format!("left_out[{k}].point"), &left.point));
        for (field, point) in points.chain(left) {
            names(format!("{field}.view"), point.view, "views", views)?;
            for (j, costs) in point.costs.iter().enumerate() {
                names(format!("{field}.costs[{j}].machine"), costs.machine, "machines", machines)?;
            }
        }
        for (k, size) in self.sizes.iter().enumerate() {
            names(format!("sizes[{k}].view"), size.view, "views", views)?;
            for (j, costs) in size.costs.iter().enumerate() {
                names(format!("sizes[{k}].costs[{j}].machine"), costs.machine, "machines", machines)?;
            }
        }
        for (k, equal) in self.equal_error.iter().enumerate() {
            names(format!("equal_error[{k}].view"), equal.view, "views", views)?;
            names(format!("equal_error[{k}].machine"), equal.machine, "machines", machines)?;
        }
        for (k, picture) in self.pictures.iter().enumerate() {
            names(format!("pictures[{k}].view"), picture.view, "views", views)?;
        }
        for (k, grid) in self.traces.iter().enumerate() {
            names(format!("traces[{k}].view"), grid.view, "views", views)?;
        }
        Ok(())
    }
}
