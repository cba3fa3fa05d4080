//! Rays from arrays of NumPy's, which are not copied if they are contiguous arrays of float64, and hits as structured arrays.

use crate::errors::{raised, refused};
use lodray::rays::{Column, RAY_COLUMNS, RayRows};
use lodray::run::HitRow;
use npyz::{AutoSerialize, Serialize, TypeWrite};
use numpy::{Element, PyArray1, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt};
use rayon::prelude::*;

/// Columns of each row that there are files of.
const WIDTHS: [usize; 5] = [6, 8, 10, 11, 12];

/// The fields of a row of twelve columns: name, and how many.
const FIELDS: [(&str, usize); 8] =
    [("origin", 3), ("direction", 3), ("radius", 1), ("cone", 1), ("t_min", 1), ("t_max", 1), ("any", 1), ("after", 1)];

/// Where a column's values are.
#[derive(Clone, Copy)]
enum Place {
    All(f64),
    Each { array: usize, step: usize, first: usize },
}

/// Rays in arrays that are held while they are read.
pub struct Rays<'py> {
    arrays: Vec<PyReadonlyArrayDyn<'py, f64>>,
    columns: [Place; RAY_COLUMNS],
}

/// What may be said of rays beside their origins and directions: a number for all, or an array with one for each.
#[derive(Default)]
pub struct Asked<'py> {
    /// Radius of the cone at the origin.
    pub radius: Option<Bound<'py, PyAny>>,
    /// Tangent of its half angle.
    pub cone: Option<Bound<'py, PyAny>>,
    /// Nearest distance that counts.
    pub t_min: Option<Bound<'py, PyAny>>,
    /// Farthest distance that counts.
    pub t_max: Option<Bound<'py, PyAny>>,
}

/// Numbers that arrays are read as.
pub trait Read: Element {
    /// The type as NumPy names it.
    const DTYPE: &'static str;
    /// Kinds of types, as NumPy names them, that are such numbers: without this, dates and texts would be cast, and parts of complex numbers be lost.
    const KINDS: &'static str;
    /// What they are called.
    const WORDS: &'static str;
}

impl Read for f64 {
    const DTYPE: &'static str = "f8";
    const KINDS: &'static str = "iuf";
    const WORDS: &'static str = "numbers";
}

impl Read for i64 {
    const DTYPE: &'static str = "i8";
    const KINDS: &'static str = "iu";
    const WORDS: &'static str = "whole numbers";
}

/// An array as contiguous values of a type: itself if it is one. `of` names it in errors.
pub fn contiguous<'py, T: Read>(of: &str, array: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, T>> {
    let (py, numpy) = (array.py(), array.py().import("numpy")?);
    let named = |error: PyErr| {
        // Others, such as KeyboardInterrupt and MemoryError, say nothing of the array.
        if !error.is_instance_of::<PyTypeError>(py) && !error.is_instance_of::<PyValueError>(py) {
            return error;
        }
        let said = refused(format!("{of}: {}", error.value(py)));
        said.set_cause(py, Some(error));
        said
    };
    let made = numpy.call_method1("asanyarray", (array,)).map_err(named)?;
    unmasked(of, &made)?;
    let dtype = made.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    // To NumPy whole numbers of more than 64 bits are objects.
    let fits = T::KINDS.contains(&kind) || (kind == "O" && T::KINDS.contains('f') && are_real(&made)?);
    if !fits {
        return Err(refused(format!("{of}: of type {dtype}, not of {}", T::WORDS)));
    }
    let made = numpy.call_method1("require", (made, T::DTYPE, ("C_CONTIGUOUS", "ALIGNED"))).map_err(named)?;
    made.extract().map_err(|_| refused(format!("{of}: no array of numbers")))
}

/// Whether all objects of an array are real numbers.
fn are_real(array: &Bound<'_, PyAny>) -> PyResult<bool> {
    let real = array.py().import("numbers")?.getattr("Real")?;
    for object in array.getattr("flat")?.try_iter()? {
        if !object?.is_instance(&real)? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Refuses an array of which entries are masked.
fn unmasked(of: &str, array: &Bound<'_, PyAny>) -> PyResult<()> {
    let mask = array.py().import("numpy.ma")?.call_method1("getmask", (array,))?;
    // Of structured arrays masks have fields too: their bytes do not.
    let masked = mask.call_method0("tobytes")?.extract::<Vec<u8>>()?.contains(&1);
    if masked { Err(refused(format!("{of}: entries of it are masked"))) } else { Ok(()) }
}

/// The numbers of an array of shape (n, 3), three by three.
pub fn triples<'a, T: Element>(of: &str, array: &'a PyReadonlyArrayDyn<'_, T>) -> PyResult<&'a [[T; 3]]> {
    match array.shape() {
        [_, 3] => Ok(array.as_slice().map_err(raised)?.as_chunks().0),
        shape => Err(refused(format!("{of}: an array of shape {shape:?}, not (n, 3)"))),
    }
}

impl<'py> Rays<'py> {
    /// Rays of origins and directions, or of one array of rows.
    pub fn of(rays: &Bound<'py, PyAny>, directions: Option<&Bound<'py, PyAny>>, asked: &Asked<'py>) -> PyResult<Self> {
        let mut all = Self { arrays: Vec::new(), columns: [Place::All(0.0); RAY_COLUMNS] };
        all.columns[9] = Place::All(f64::INFINITY);
        all.columns[11] = Place::All(-1.0);
        match directions {
            Some(directions) => all.apart(rays, directions)?,
            None => all.together(rays)?,
        }
        let own = [("radius", 6, &asked.radius), ("cone", 7, &asked.cone), ("t_min", 8, &asked.t_min), ("t_max", 9, &asked.t_max)];
        for (name, column, value) in own {
            if let Some(value) = value {
                all.column(name, column, value)?;
            }
        }
        Ok(all)
    }

    fn apart(&mut self, origins: &Bound<'py, PyAny>, directions: &Bound<'py, PyAny>) -> PyResult<()> {
        let [origins, directions] = [("origins", origins), ("directions", directions)].map(|(of, array)| contiguous(of, array));
        let both = [origins?, directions?];
        let shapes = [both[0].shape().to_vec(), both[1].shape().to_vec()];
        for (k, (of, array)) in ["origins", "directions"].into_iter().zip(both).enumerate() {
            match *array.shape() {
                // One for all rays of the other, or a single ray.
                [3] if shapes[1 - k].len() == 2 => {
                    let values = array.as_slice().map_err(raised)?;
                    (0..3).for_each(|axis| self.columns[3 * k + axis] = Place::All(values[axis]));
                }
                [3] | [_, 3] => {
                    (0..3).for_each(|axis| self.columns[3 * k + axis] = Place::Each { array: self.arrays.len(), step: 3, first: axis });
                    self.arrays.push(array);
                }
                ref shape => return Err(refused(format!("{of}: an array of shape {shape:?}, not (n, 3)"))),
            }
        }
        if shapes[0].len() == 2 && shapes[1].len() == 2 && shapes[0] != shapes[1] {
            return Err(refused(format!("origins: shape {:?}, but directions has {:?}", shapes[0], shapes[1])));
        }
        Ok(())
    }

    fn together(&mut self, rays: &Bound<'py, PyAny>) -> PyResult<()> {
        // Arrays of other packages have types without names.
        let names = rays.getattr_opt("dtype")?.map(|dtype| dtype.getattr_opt("names")).transpose()?.flatten();
        let array = if names.is_some_and(|names| !names.is_none()) { rows_of(rays)? } else { contiguous("rays", rays)? };
        let width = match *array.shape() {
            [_, width] if WIDTHS.contains(&width) => width,
            [_, 3] => return Err(refused("directions: missing; rays in one array have 6, 8, 10, 11 or 12 columns")),
            ref shape => return Err(refused(format!("rays: an array of shape {shape:?}, not of rows of 6, 8, 10, 11 or 12 columns"))),
        };
        (0..width).for_each(|column| self.columns[column] = Place::Each { array: self.arrays.len(), step: width, first: column });
        self.arrays.push(array);
        Ok(())
    }

    fn column(&mut self, name: &str, column: usize, value: &Bound<'py, PyAny>) -> PyResult<()> {
        if value.is_instance_of::<PyFloat>() || value.is_instance_of::<PyInt>() {
            self.columns[column] = Place::All(value.extract().map_err(|_| refused(format!("{name}: {value} is too large")))?);
            return Ok(());
        }
        let array = contiguous(name, value)?;
        match *array.shape() {
            [] => {
                self.columns[column] = Place::All(array.as_slice().map_err(raised)?[0]);
                Ok(())
            }
            [rays] if Some(rays) == self.rays() => {
                self.columns[column] = Place::Each { array: self.arrays.len(), step: 1, first: 0 };
                self.arrays.push(array);
                Ok(())
            }
            ref shape => Err(refused(format!("{name}: neither a number nor an array with one for each ray, but of shape {shape:?}"))),
        }
    }

    /// How many there are.
    fn rays(&self) -> Option<usize> {
        self.arrays.first().map(|array| if array.ndim() == 1 { array.len() / 3 } else { array.shape()[0] })
    }

    /// The rays, checked.
    pub fn rows(&self) -> PyResult<RayRows<'_>> {
        let slices = self.arrays.iter().map(|array| array.as_slice()).collect::<Result<Vec<_>, _>>().map_err(raised)?;
        let column = |place: Place| match place {
            Place::All(value) => Column::All(value),
            Place::Each { array, step, first } => Column::Each { values: slices[array], step, first },
        };
        RayRows::new(self.columns.map(column)).map_err(raised)
    }
}

/// Rays of a structured array as rows.
fn rows_of<'py>(rays: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    let wanted = ray_dtype(rays.py())?;
    if !rays.getattr("dtype")?.eq(&wanted)? {
        return Err(refused(format!("rays: of type {}, not of lodray.RAY", rays.getattr("dtype")?)));
    }
    unmasked("rays", rays)?;
    let rays = rays.py().import("numpy")?.call_method1("ascontiguousarray", (rays,))?;
    contiguous("rays", &rays.call_method1("view", ("f8",))?.call_method1("reshape", ((-1, RAY_COLUMNS),))?)
}

/// The type of rays in one array: a view of rows of twelve columns.
pub fn ray_dtype(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let fields: Vec<_> =
        FIELDS.iter().map(|&(name, many)| if many == 1 { (name, "<f8".to_owned()) } else { (name, format!("{many}<f8")) }).collect();
    py.import("numpy")?.call_method1("dtype", (fields,))
}

/// The type of hits: that of the arrays that `lodray cast` writes.
pub fn hit_dtype(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let fields = py.import("ast")?.call_method1("literal_eval", (HitRow::default_dtype().descr(),))?;
    py.import("numpy")?.call_method1("dtype", (fields,))
}

/// Bytes of a hit.
pub fn hit_bytes() -> usize {
    HitRow::default_dtype().num_bytes().unwrap_or(0)
}

/// Writes hits as such arrays have them, where there is room for as many.
pub fn pack(hits: &[HitRow], out: &mut [u8]) -> PyResult<()> {
    /// Hits of a thread at a time.
    const PART: usize = 1 << 12;
    let (dtype, bytes) = (HitRow::default_dtype(), hit_bytes());
    let parts = out.par_chunks_mut(PART * bytes).zip(hits.par_chunks(PART));
    let written = parts.try_for_each(|(mut out, hits)| {
        let writer = HitRow::writer(&dtype).map_err(|error| error.to_string())?;
        hits.iter().try_for_each(|hit| writer.write_one(&mut out, hit)).map_err(|error| error.to_string())
    });
    written.map_err(refused)
}

/// Hits as an array of NumPy's.
pub fn hits<'py>(py: Python<'py>, packed: Vec<u8>) -> PyResult<Bound<'py, PyAny>> {
    PyArray1::from_vec(py, packed).call_method1("view", (hit_dtype(py)?,))
}

/// The rows of rays that somebody made, as an array of them.
pub fn rays<'py>(py: Python<'py>, rows: Vec<f64>) -> PyResult<Bound<'py, PyAny>> {
    PyArray1::from_vec(py, rows).call_method1("view", (ray_dtype(py)?,))
}

/// An array of this shape of the values.
pub fn shaped<'py, T: Element>(py: Python<'py>, values: Vec<T>, shape: &[usize]) -> PyResult<Bound<'py, PyAny>> {
    PyArray1::from_vec(py, values).call_method1("reshape", (shape.to_vec(),))
}

/// Keywords that knobs were turned by, as the program's options have them.
pub fn knobs(given: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<(String, String)>> {
    let each = given.into_iter().flat_map(|given| given.iter());
    each.map(|(name, value)| Ok((name.extract::<String>()?.replace('_', "-"), crate::values::option(&value)?))).collect()
}
