//! Rays from a file, as NumPy writes arrays.
//!
//! A row of 32-bit or 64-bit floats for each ray, of 6, 8, 10, 11 or 12 columns:
//!
//! | columns | what | without them |
//! |---|---|---|
//! | 0 to 2 | origin, in world units | |
//! | 3 to 5 | direction, of any length but 0 | |
//! | 6, 7 | radius of the cone at the origin, and how much it grows per unit of length | 0, 0 |
//! | 8, 9 | nearest and farthest distance that counts | 0, infinite |
//! | 10 | 1 if any hit serves, 0 if it must be the closest | 0 |
//! | 11 | number of the earlier row at whose hit the ray starts (`cast`), or behind whose end (`simulate`), -1 if none; 32-bit floats number 2^24 rows | -1 |

use super::eye::{eye_of_all, least_radius_of_all};
use super::rows::{BATCH, query};
use super::{Eye, ModelSpace, Query, RaySource};
use crate::mesh::{ArrayError, floats, open_array, shape_and_type};
use npyz::{DType, Order, TypeChar};
use rayon::prelude::*;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Most rays of a file.
const MOST: u64 = 1 << 28;

/// Why a file of rays cannot be read.
#[derive(Debug, Error)]
#[error("{path}: {why}")]
pub struct RayFileError {
    path: PathBuf,
    why: Why,
}

#[derive(Debug, Error)]
enum Why {
    #[error("{0}")]
    Io(io::Error),
    #[error("an array of {0}, where rays are rows of 6, 8, 10, 11 or 12 floats (float32 or float64)")]
    Shape(String),
    #[error("{0}")]
    Array(#[from] ArrayError),
    #[error("{0} rays: at most 2^28")]
    TooMany(u64),
    #[error("{0} rays of 12 columns of float32, which cannot number rays beyond 2^24: take float64")]
    Numbers(u64),
    #[error("ray {0}: {1}")]
    Ray(u64, String),
}

/// The rays of a file, in its order.
#[derive(Clone, Debug, PartialEq)]
pub struct RayFile {
    queries: Vec<Query>,
    is_ordered: bool,
}

impl RayFile {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// It cannot be read, is no array of NumPy's, has another shape, or a ray that cannot be: the number of its row is named.
    pub fn read(path: &Path) -> Result<Self, RayFileError> {
        let wrong = |why| RayFileError { path: path.to_owned(), why };
        let file = File::open(path).map_err(|error| wrong(Why::Io(error)))?;
        Self::parse(BufReader::new(file)).map_err(wrong)
    }

    fn parse(bytes: impl Read) -> Result<Self, Why> {
        let file = open_array(bytes)?;
        let (shape, order, dtype) = (file.shape().to_vec(), file.order(), file.dtype());
        let size = match &dtype {
            DType::Plain(of) if of.type_char() == TypeChar::Float => of.size_field(),
            _ => 0,
        };
        let (rows, columns) = match shape[..] {
            [rows, columns] if [6, 8, 10, 11, 12].contains(&columns) && [4, 8].contains(&size) => (rows, columns as usize), // at most 12
            _ => return Err(Why::Shape(shape_and_type(&file))),
        };
        if rows > MOST {
            return Err(Why::TooMany(rows));
        }
        if columns == 12 && size == 4 && rows > 1 << 24 {
            return Err(Why::Numbers(rows));
        }
        let values = floats(file, size)?;
        let rows = rows as usize; // at most MOST
        let value = |row: usize, column: usize| match order {
            Order::C => values[row * columns + column],
            Order::Fortran => values[column * rows + row],
        };
        let query = |row: usize| {
            let cells: Vec<f64> = (0..columns).map(|column| value(row, column)).collect();
            query(row as u64, &cells).map_err(|why| Why::Ray(row as u64, why))
        };
        let queries = (0..rows).map(query).collect::<Result<Vec<_>, _>>()?;
        Ok(Self::new(queries))
    }

    /// Rays of whoever has them; each starts behind earlier ones only.
    ///
    /// # Panics
    /// A ray starts behind itself or a later one.
    pub fn new(queries: Vec<Query>) -> Self {
        let is_earlier = |(number, query): (usize, &Query)| query.after.is_none_or(|after| after < number as u64);
        assert!(queries.iter().enumerate().all(is_earlier), "a ray starts behind earlier ones only");
        Self { is_ordered: queries.iter().any(|query| query.after.is_some()), queries }
    }

    /// The rays.
    pub fn queries(&self) -> &[Query] {
        &self.queries
    }
}

impl RaySource for RayFile {
    fn rays(&self) -> u64 {
        self.queries.len() as u64
    }

    fn batches(&self) -> usize {
        self.queries.len().div_ceil(BATCH)
    }

    fn batch(&self, batch: usize, each: &mut dyn FnMut(u64, &Query)) {
        let queries = self.queries.iter().enumerate().skip(batch * BATCH).take(BATCH);
        queries.for_each(|(number, query)| each(number as u64, query));
    }

    fn is_ordered(&self) -> bool {
        self.is_ordered
    }

    fn least_radius(&self, space: &ModelSpace) -> f64 {
        least_radius_of_all(self.queries.par_iter().copied(), space)
    }

    fn eyes(&self, space: &ModelSpace) -> Vec<Eye> {
        vec![eye_of_all(self.queries.par_iter().copied(), space)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use npyz::WriterBuilder;

    fn array(shape: &[u64], order: Order, values: &[f64]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut writer = npyz::WriteOptions::new().default_dtype().shape(shape).order(order).writer(&mut bytes).begin_nd().unwrap();
        writer.extend(values.iter()).unwrap();
        writer.finish().unwrap();
        bytes
    }

    fn refused(shape: &[u64], values: &[f64]) -> String {
        RayFile::parse(&*array(shape, Order::C, values)).unwrap_err().to_string()
    }

    #[test]
    fn rows_are_queries_in_either_order() {
        let rows = [
            [1.0, 2.0, 3.0, 0.0, 0.0, -1.0, 0.5, 0.25, 1.0, 9.0, 0.0, -1.0],
            [4.0, 5.0, 6.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, f64::INFINITY, 1.0, 0.0],
        ];
        let first = Query::new([1.0, 2.0, 3.0], [0.0, 0.0, -1.0]).with_cone(0.5, 0.25).between(1.0, 9.0);
        let second = Query { any: true, after: Some(0), ..Query::new([4.0, 5.0, 6.0], [1.0, 0.0, 0.0]) };
        let turned: Vec<f64> = (0..12).flat_map(|column| rows.map(|row| row[column])).collect();
        for bytes in [array(&[2, 12], Order::C, rows.as_flattened()), array(&[2, 12], Order::Fortran, &turned)] {
            let file = RayFile::parse(&*bytes).unwrap();
            assert_eq!(file.queries(), [first, second]);
            assert!(file.is_ordered());
        }
        let short = RayFile::parse(&*array(&[1, 6], Order::C, &rows[0][..6])).unwrap();
        assert_eq!((short.queries(), short.is_ordered()), (&[Query::new([1.0, 2.0, 3.0], [0.0, 0.0, -1.0])][..], false));
        assert_eq!(RayFile::parse(&*array(&[0, 8], Order::C, &[])).unwrap().rays(), 0);
    }

    #[test]
    fn what_is_no_ray_is_refused_by_its_number() {
        let good = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0];
        let with = |column: usize, value: f64| {
            let mut rows = [good, good];
            rows[1][column] = value;
            refused(&[2, 12], rows.as_flattened())
        };
        for (column, value, said) in [
            (0, f64::NAN, "finite"),
            (3, 0.0, "no length"),
            (4, f64::INFINITY, "finite"),
            (6, -1.0, "cone"),
            (7, f64::NAN, "cone"),
            (8, 2.0, "nearest"),
            (9, f64::NAN, "nearest"),
            (10, 0.5, "column 10"),
            (11, 1.0, "earlier"),
            (11, 0.5, "earlier"),
            (11, -2.0, "earlier"),
        ] {
            let why = with(column, value);
            assert!(why.starts_with("ray 1: ") && why.contains(said), "{column} {value}: {why}");
        }
        assert!(refused(&[2, 7], &[0.0; 14]).contains("shape [2, 7]"));
        assert!(refused(&[12], &[0.0; 12]).contains("shape [12]"));
        assert!(RayFile::parse(&b"not an array"[..]).unwrap_err().to_string().contains("no array of NumPy's"));
        let cut = array(&[2, 12], Order::C, &[0.0; 24]);
        assert!(RayFile::parse(&cut[..cut.len() - 1]).is_err());
    }
}
