//! Rays in arrays that somebody else keeps, column by column, and what a row of a file of rays says.

use super::eye::{eye_of_all, least_radius_of_all};
use super::{Eye, ModelSpace, Query, RaySource};
use rayon::prelude::*;
use thiserror::Error;

/// Rays of a batch.
pub(super) const BATCH: usize = 64;

/// Columns of a row: those of a file of rays.
pub const RAY_COLUMNS: usize = 12;

/// A row that is no ray.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("ray {ray}: {why}")]
pub struct RowError {
    /// Its number.
    pub ray: u64,
    /// What is wrong with it.
    pub why: String,
}

/// A column of rays.
#[derive(Clone, Copy, Debug)]
pub enum Column<'a> {
    /// All rays have this value.
    All(f64),
    /// Each has its own.
    Each {
        /// Where they lie, among others.
        values: &'a [f64],
        /// How many from one ray to the next; 1 at least.
        step: usize,
        /// The place of the first ray's.
        first: usize,
    },
}

impl Column<'_> {
    /// Rays that there are values for; as many as anybody wants if all have the same.
    fn rays(&self) -> usize {
        match *self {
            Self::All(_) => usize::MAX,
            Self::Each { values, step, first } => values.len().saturating_sub(first).div_ceil(step.max(1)),
        }
    }

    #[inline]
    fn of(&self, ray: usize) -> f64 {
        match *self {
            Self::All(value) => value,
            Self::Each { values, step, first } => values[ray * step + first],
        }
    }

    /// The same from a later ray on.
    fn behind(self, rays: usize) -> Self {
        match self {
            Self::All(_) => self,
            Self::Each { values, step, first } => Self::Each { values, step, first: first + rays * step },
        }
    }
}

/// Rays in arrays, which are not copied. Each starts at its own origin, whichever it names as the one before.
#[derive(Clone, Copy, Debug)]
pub struct RayRows<'a> {
    columns: [Column<'a>; RAY_COLUMNS],
    rays: usize,
    /// The number of the first, in errors.
    number: u64,
}

impl<'a> RayRows<'a> {
    /// As many rays as all columns have values for, checked: the columns are those of a file of rays.
    ///
    /// # Errors
    /// The first that cannot be.
    pub fn new(columns: [Column<'a>; RAY_COLUMNS]) -> Result<Self, RowError> {
        let rays = columns.iter().map(Column::rays).min().filter(|&rays| rays < usize::MAX).unwrap_or(0);
        let all = Self { columns, rays, number: 0 };
        let wrong = |ray| all.query(ray).err().map(|why| RowError { ray: ray as u64, why });
        match (0..rays).into_par_iter().find_map_first(wrong) {
            Some(error) => Err(error),
            None => Ok(all),
        }
    }

    /// What a ray asks that nobody said more of than its origin and its direction.
    pub const fn plain(origin: [Column<'a>; 3], direction: [Column<'a>; 3]) -> [Column<'a>; RAY_COLUMNS] {
        let ([x, y, z], [u, v, w]) = (origin, direction);
        let (zero, far, none) = (Column::All(0.0), Column::All(f64::INFINITY), Column::All(-1.0));
        [x, y, z, u, v, w, zero, zero, zero, far, zero, none]
    }

    /// Some of them, from the first on that is wanted.
    #[must_use]
    pub fn part(self, first: usize, rays: usize) -> Self {
        let first = first.min(self.rays);
        let columns = self.columns.map(|column| column.behind(first));
        Self { columns, rays: rays.min(self.rays - first), number: self.number + first as u64 }
    }

    /// A ray.
    ///
    /// # Errors
    /// What of it cannot be.
    #[inline]
    pub fn query(&self, ray: usize) -> Result<Query, String> {
        query(self.number + ray as u64, &std::array::from_fn::<_, RAY_COLUMNS, _>(|column| self.columns[column].of(ray)))
    }

    /// Some ray names an earlier one.
    pub fn are_ordered(&self) -> bool {
        !matches!(self.columns[RAY_COLUMNS - 1], Column::All(_)) && self.each().any(|query| query.after.is_some())
    }

    /// All of them.
    pub fn queries(&self) -> Vec<Query> {
        // They were checked.
        (0..self.rays).into_par_iter().filter_map(|ray| self.query(ray).ok()).collect()
    }

    fn each(&self) -> impl ParallelIterator<Item = Query> {
        (0..self.rays).into_par_iter().filter_map(|ray| self.query(ray).ok())
    }
}

/// The ray of a row, of as many columns as it has.
#[inline]
pub(super) fn query(row: u64, cells: &[f64]) -> Result<Query, String> {
    let three = |at: usize| [cells[at], cells[at + 1], cells[at + 2]];
    let (origin, direction) = (three(0), three(3));
    if !origin.iter().chain(&direction).all(|v| v.is_finite()) {
        return Err("origin and direction must be finite numbers".to_owned());
    }
    if direction == [0.0; 3] {
        return Err("the direction has no length".to_owned());
    }
    let mut query = Query::new(origin, direction);
    if let Some(&[radius, tan_theta]) = cells.get(6..8) {
        if !(radius >= 0.0 && tan_theta >= 0.0 && radius.is_finite() && tan_theta.is_finite()) {
            return Err(format!("the cone must be two numbers of 0 or more, not {radius} and {tan_theta}"));
        }
        query = query.with_cone(radius, tan_theta);
    }
    if let Some(&[near, far]) = cells.get(8..10) {
        // Not a number fails too.
        if near.partial_cmp(&far).is_none_or(std::cmp::Ordering::is_gt) {
            return Err(format!("the nearest distance must be at most the farthest, not {near} and {far}"));
        }
        query = query.between(near, far);
    }
    if let Some(&any) = cells.get(10) {
        if any != 0.0 && any != 1.0 {
            return Err(format!("column 10 must be 1 (any hit) or 0 (the closest), not {any}"));
        }
        query.any = any == 1.0;
    }
    if let Some(&after) = cells.get(11).filter(|&&after| after != -1.0) {
        let earlier = after >= 0.0 && after.fract() == 0.0 && after < row as f64;
        if !earlier {
            return Err(format!("column 11 must be the number of an earlier ray, or -1, not {after}"));
        }
        query.after = Some(after as u64);
    }
    Ok(query)
}

impl RaySource for RayRows<'_> {
    fn rays(&self) -> u64 {
        self.rays as u64
    }

    fn batches(&self) -> usize {
        self.rays.div_ceil(BATCH)
    }

    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query)) {
        for ray in batch * BATCH..self.rays.min((batch + 1) * BATCH) {
            if let Ok(query) = self.query(ray) {
                each(ray as u64, &query);
            }
        }
    }

    fn least_radius(&self, space: &ModelSpace) -> f64 {
        least_radius_of_all(self.each(), space)
    }

    fn eyes(&self, space: &ModelSpace) -> Vec<Eye> {
        vec![eye_of_all(self.each(), space)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rays::RayFile;

    fn each(values: &[f64], step: usize, first: usize) -> Column<'_> {
        Column::Each { values, step, first }
    }

    #[test]
    fn rows_are_those_of_a_file_wherever_their_columns_lie() {
        let rows = [
            [1.0, 2.0, 3.0, 0.0, 0.0, -1.0, 0.5, 0.25, 1.0, 9.0, 0.0, -1.0],
            [4.0, 5.0, 6.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, f64::INFINITY, 1.0, 0.0],
            [7.0, 5.0, 6.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 1.0, -1.0],
        ];
        let together = RayRows::new(std::array::from_fn(|column| each(rows.as_flattened(), RAY_COLUMNS, column))).unwrap();
        let apart: [Vec<f64>; RAY_COLUMNS] = std::array::from_fn(|column| rows.map(|row| row[column]).to_vec());
        let columns = RayRows::new(std::array::from_fn(|column| each(&apart[column], 1, 0))).unwrap();
        let file = RayFile::new(together.queries());
        assert_eq!((together.rays(), together.are_ordered(), file.queries()), (3, true, &columns.queries()[..]));
        assert_eq!(file.queries()[1], Query { any: true, after: Some(0), ..Query::new([4.0, 5.0, 6.0], [1.0, 0.0, 0.0]) });
        let later = together.part(1, 9);
        assert_eq!((later.rays(), later.query(1)), (2, together.query(2)));
        assert_eq!((together.part(1, 1).rays(), together.part(5, 1).rays()), (1, 0));
        let mut seen = Vec::new();
        later.batch(0, &mut |number, query| seen.push((number, *query)));
        assert_eq!(seen, [(0, file.queries()[1]), (1, file.queries()[2])]);
    }

    #[test]
    fn what_nobody_says_is_as_in_a_short_file_and_what_is_no_ray_has_its_number() {
        let values = [0.0, 0.0, 5.0, 0.0, 0.0, -1.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0];
        let [origin, direction] = [0, 3].map(|first| std::array::from_fn(|k| each(&values, 6, first + k)));
        assert_eq!(RayRows::new(RayRows::plain(origin, direction)).unwrap_err().to_string(), "ray 1: the direction has no length");
        let one = origin.map(|column| match column {
            Column::Each { values, step, first } => each(&values[..6], step, first),
            all => all,
        });
        let rays = RayRows::new(RayRows::plain(one, direction)).unwrap();
        assert_eq!((rays.queries(), rays.are_ordered()), (vec![Query::new([0.0, 0.0, 5.0], [0.0, 0.0, -1.0])], false));
        assert_eq!(RayRows::new([Column::All(1.0); RAY_COLUMNS]).unwrap().rays(), 0, "no column has any");
    }
}
