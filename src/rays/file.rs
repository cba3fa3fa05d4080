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
use crate::mesh::nests_too_deep;
use npyz::{DType, NpyFile, Order, TypeChar};
use rayon::prelude::*;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Most rays of a file.
const MOST: u64 = 1 << 28;

/// Most bytes of a header: one of an array of rays has a hundred or so.
const MOST_HEADER: u32 = 1 << 16;

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
    #[error("a header of {0} bytes, where arrays of rays have at most 2^16")]
    Header(u32),
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

    fn parse(mut bytes: impl Read) -> Result<Self, Why> {
        // What the file says of its header's length is believed only if it is that of an array of rays.
        let mut start = Vec::new();
        bytes.by_ref().take(12).read_to_end(&mut start).map_err(Why::Io)?;
        if start.starts_with(b"\x93NUMPY") && start.len() == 12 {
            let (from, length) = match start[6] {
                0 | 1 => (10, u32::from(u16::from_le_bytes([start[8], start[9]]))),
                _ => (12, u32::from_le_bytes([start[8], start[9], start[10], start[11]])),
            };
            if length > MOST_HEADER {
                return Err(Why::Header(length));
            }
            let missing = (from + u64::from(length)).saturating_sub(12);
            bytes.by_ref().take(missing).read_to_end(&mut start).map_err(Why::Io)?;
            let header = &start[from as usize..];
            if nests_too_deep(header) {
                return Err(Why::Shape("no rows of one type".to_owned()));
            }
            if !is_countable(header) {
                return Err(Why::Shape("a shape that cannot be".to_owned()));
            }
        }
        let file = NpyFile::new(start.as_slice().chain(bytes))
            .map_err(|error| Why::Io(io::Error::new(error.kind(), format!("no array of NumPy's: {error}"))))?;
        let (shape, order, dtype) = (file.shape().to_vec(), file.order(), file.dtype());
        let shown = || format!("shape {shape:?} and type {}", dtype.descr());
        let size = match &dtype {
            DType::Plain(of) if of.type_char() == TypeChar::Float => of.size_field(),
            _ => 0,
        };
        let (rows, columns) = match shape[..] {
            [rows, columns] if [6, 8, 10, 11, 12].contains(&columns) && [4, 8].contains(&size) => (rows, columns as usize), // at most 12
            _ => return Err(Why::Shape(shown())),
        };
        if rows > MOST {
            return Err(Why::TooMany(rows));
        }
        if columns == 12 && size == 4 && rows > 1 << 24 {
            return Err(Why::Numbers(rows));
        }
        let values: Vec<f64> = match size {
            4 => file.into_vec::<f32>().map_err(Why::Io)?.into_iter().map(f64::from).collect(),
            _ => file.into_vec().map_err(Why::Io)?,
        };
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

/// Whether the sizes of a header's shape have a product: the reader of arrays takes that for granted.
fn is_countable(header: &[u8]) -> bool {
    let text = String::from_utf8_lossy(header);
    let shape = text.split_once("shape").and_then(|(_, rest)| rest.split_once('(')?.1.split_once(')')).map_or("", |(shape, _)| shape);
    let sizes = shape.split(',').map(|size| size.trim().trim_end_matches('L')).filter(|size| !size.is_empty());
    sizes.map(|size| size.parse::<u64>().ok()).try_fold(1u64, |all, size| all.checked_mul(size?.max(1))).is_some()
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

    #[test]
    fn headers_that_promise_too_much_are_refused() {
        let head = |version: u8, length: &[u8], text: &str| [b"\x93NUMPY", &[version, 0][..], length, text.as_bytes()].concat();
        let why = |bytes: &[u8]| RayFile::parse(bytes).unwrap_err().to_string();
        assert_eq!(why(&head(2, &[0xff; 4], "")), "a header of 4294967295 bytes, where arrays of rays have at most 2^16");
        for shape in ["9223372036854775807, 8", "0, 9223372036854775807, 8", "99999999999999999999, 6"] {
            let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}\n");
            let said = why(&head(1, &(text.len() as u16).to_le_bytes(), &text));
            assert!(said.starts_with("an array of a shape that cannot be"), "{said}");
        }
    }

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
