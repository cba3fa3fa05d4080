//! SVG as PNG.

use super::fault::{DiagramFault, wrong};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};
use std::sync::Arc;

/// The only font: the same picture on every machine.
const FONT: &[u8] = include_bytes!("font/DejaVuSans.ttf");
const FAMILY: &str = "DejaVu Sans";

/// A drawing as PNG, `scale` times as large.
///
/// # Errors
/// It is no SVG, or has no size.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, DiagramFault> {
    let mut fonts = fontdb::Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let options = Options { font_family: FAMILY.to_owned(), fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(wrong)?;
    let size = tree.size().to_int_size().scale_by(scale).ok_or_else(|| wrong("it has no size"))?;
    let mut picture = Pixmap::new(size.width(), size.height()).ok_or_else(|| wrong("it has no size"))?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut picture.as_mut());
    picture.encode_png().map_err(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawings_have_text_and_their_size() {
        let svg = |text: &str| {
            format!(
                "<svg width=\"60\" height=\"20\" xmlns=\"http://www.w3.org/2000/svg\"><text x=\"2\" y=\"15\" font-family=\"sans-serif\" font-size=\"14\">{text}</text></svg>"
            )
        };
        let [with, without] = ["δ 1/16 ×", ""].map(|text| image::load_from_memory(&png(&svg(text), 2.0).unwrap()).unwrap().to_rgba8());
        assert_eq!(with.dimensions(), (120, 40));
        assert!(with != without && without.pixels().all(|pixel| pixel.0[3] == 0));
        assert!(png("<svg", 1.0).is_err());
    }
}
