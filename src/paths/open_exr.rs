//! Pictures of paths as OpenEXR.

use super::Film;
use crate::format::write_and_rename;
use exr::image::pixel_vec::PixelVec;
use exr::prelude::{Image, ImageAttributes, Layer, LayerAttributes, SpecificChannels, Text, WritableImage};
use std::io::{self, Cursor};
use std::path::Path;
use thiserror::Error;

/// A picture cannot be written.
#[derive(Debug, Error)]
pub enum ExrError {
    /// The file.
    #[error(transparent)]
    Write(#[from] io::Error),
    /// Its contents.
    #[error("{0}")]
    Exr(#[from] exr::error::Error),
}

impl Film {
    /// Writes the light as OpenEXR, 32-bit floats; it says what it is.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn save_exr(&self, software: &str, what: &str, path: &Path) -> Result<(), ExrError> {
        let pixels = PixelVec::new((self.width as usize, self.height as usize), self.light.iter().map(|c| (c.x, c.y, c.z)).collect());
        let channels = SpecificChannels::rgb(pixels);
        // Attributes of other names would be written in any order.
        let own = LayerAttributes {
            software_name: Some(Text::from(software)),
            comments: Some(Text::from(what)),
            ..LayerAttributes::named("lodray")
        };
        let size = exr::math::Vec2(self.width as usize, self.height as usize);
        let layer = Layer::new(size, own, exr::image::Encoding::SMALL_LOSSLESS, channels);
        let image = Image::new(ImageAttributes::with_size(size), layer);
        let mut bytes = Cursor::new(Vec::new());
        image.write().non_parallel().to_buffered(&mut bytes)?;
        Ok(write_and_rename(path, |out| out.write_all(bytes.get_ref()))?)
    }
}
