//! Heights in OpenEXR.

use exr::meta::BlockDescription;
use exr::prelude::{MetaData, ReadChannels, ReadLayers, read};
use std::io::Cursor;

/// Most texels of a tile that is larger than the picture: whoever reads it makes room for all of it.
const MOST_OF_A_TILE: usize = 1 << 18;

/// Texels across and all heights, row by row, of a file of at most `most` texels.
///
/// # Errors
/// It cannot be read, or has more texels.
pub(super) fn open_exr(bytes: &[u8], most: u64) -> Result<(usize, Vec<f32>), String> {
    let fault = |error: exr::error::Error| error.to_string();
    for header in MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(fault)?.headers {
        let size = header.layer_size;
        if size.0 as u64 * size.1 as u64 > most {
            return Err(format!("{} x {} texels are more than {most}, which so many bytes may have", size.0, size.1));
        }
        if let BlockDescription::Tiles(tiles) = header.blocks {
            let tile = tiles.tile_size;
            if tile.0.saturating_mul(tile.1) > MOST_OF_A_TILE.max(size.area()) {
                return Err(format!("its tiles of {} x {} texels are far larger than its picture", tile.0, tile.1));
            }
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage};

    #[test]
    fn tiles_far_larger_than_their_picture_are_refused() {
        let channels = SpecificChannels::rgb(|at: Vec2<usize>| (at.x() as f32, at.y() as f32, 0.5_f32));
        let mut bytes = Cursor::new(Vec::new());
        Image::from_channels((9, 7), channels).write().to_buffered(&mut bytes).unwrap();
        let mut bytes = bytes.into_inner();
        assert_eq!(open_exr(&bytes, 63).unwrap().0, 9);
        // What a file of 974 bytes said by damage: whoever read it held 690 MB.
        let wide = bytes.windows(9).position(|at| at == b"tiledesc\0").unwrap() + 9 + 4;
        bytes[wide..wide + 4].copy_from_slice(&65_600_u32.to_le_bytes());
        assert_eq!(open_exr(&bytes, 63).unwrap_err(), "its tiles of 65600 x 64 texels are far larger than its picture");
    }
}
