//! Heights in OpenEXR.

use exr::prelude::{MetaData, ReadChannels, ReadLayers, read};
use std::io::Cursor;

/// Texels across and all heights, row by row, of a file of at most `most` texels.
///
/// # Errors
/// It cannot be read, or has more texels.
pub(super) fn open_exr(bytes: &[u8], most: u64) -> Result<(usize, Vec<f32>), String> {
    let fault = |error: exr::error::Error| error.to_string();
    let sizes = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?.headers.into_iter().map(|header| header.layer_size);
    if let Some(size) = sizes.into_iter().find(|size| size.0 as u64 * size.1 as u64 > most) {
        return Err(format!("{} x {} texels are more than {most}, which so many bytes may have", size.0, size.1));
    }
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer().all_attributes().non_parallel();
    let layer = image.from_buffered(Cursor::new(bytes)).map_err(fault)?.layer_data;
    let (width, height) = (layer.size.0, layer.size.1);
    let channels = &layer.channel_data.list;
    let named = |name: &str| channels.iter().find(|channel| channel.name.eq(name));
    let Some(channel) = named("Y").or_else(|| named("R")).or_else(|| channels.first()) else {
        return Err("it has no channel".to_owned());
    };
    let texels: Vec<f32> = channel.sample_data.values_as_f32().collect();
    if texels.len() != width * height {
        return Err("its channel has not a height for each texel".to_owned());
    }
    Ok((width, texels))
}
