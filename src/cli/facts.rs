//! What a picture says of itself: in its file, and on the contact sheet.

use super::comparison::Against;
use super::output::plain;
use lodray::picture::{FrameStats, Shading};
use lodray::rays::Camera;
use lodray::study::{Comparison, grouped};

/// A picture's origin and figures.
pub struct Facts<'a> {
    pub scene: &'a str,
    /// Name of the method.
    pub method: &'static str,
    /// Quality, if the method has any.
    pub delta: Option<f64>,
    /// What the method chose for the frame.
    pub choices: &'a [(&'static str, String)],
    /// Of the picture, and samples in each of its pixels.
    pub shading: (Shading, u32),
    pub camera: &'a Camera,
    pub stats: &'a FrameStats,
    pub error: Option<(Against, &'a Comparison)>,
}

type Lines = Vec<(String, String)>;

fn line(lines: &mut Lines, label: &str, value: String) {
    lines.push((label.to_owned(), value));
}

impl Facts<'_> {
    /// One line for all.
    pub fn heading(&self) -> String {
        let Camera { width, height, radii, .. } = self.camera;
        format!("{}: {}, {width}x{height} from {} radii", self.scene, self.how(), plain(*radii))
    }

    fn how(&self) -> String {
        let quality = self.delta.map_or_else(String::new, |delta| format!(" at delta {delta}"));
        let choices: String = self.choices.iter().map(|(name, value)| format!(", {name} {value}")).collect();
        format!("{}{quality}{choices}", self.method)
    }

    /// For a picture's file: what it is, where from (as options take it, in full), and the figures.
    pub fn notes(&self, picture: &str) -> Lines {
        let Camera { eye, target, up, fov, width, height, radii, .. } = *self.camera;
        let vector = |v: [f64; 3]| v.map(|c| c.to_string()).join(",");
        let mut notes = Lines::new();
        line(&mut notes, "Title", format!("{}: {picture}", self.heading()));
        line(&mut notes, "Software", format!("lodray {}", env!("CARGO_PKG_VERSION")));
        line(&mut notes, "Scene", self.scene.to_owned());
        line(&mut notes, "Method", self.method.to_owned());
        if let Some(delta) = self.delta {
            line(&mut notes, "Delta", delta.to_string());
        }
        self.choices.iter().for_each(|(name, value)| line(&mut notes, &capital(name), value.clone()));
        line(&mut notes, "Shading", self.shading.0.name().to_owned());
        line(&mut notes, "Samples", self.shading.1.to_string());
        line(&mut notes, "Size", format!("{width}x{height}"));
        line(&mut notes, "Eye", vector(eye.to_array()));
        line(&mut notes, "Target", vector(target.to_array()));
        line(&mut notes, "Up", vector(up.to_array()));
        line(&mut notes, "View angle", format!("{fov} degrees"));
        line(&mut notes, "Distance", format!("{radii} bounding radii"));
        notes.extend(self.figures().into_iter().map(|(label, value)| (capital(&label), value)));
        notes
    }

    /// For the contact sheet: view and figures, rounded.
    pub fn lines(&self) -> Lines {
        let Camera { eye, target, up, fov, width, height, radii, .. } = *self.camera;
        let vector = |v: [f64; 3]| v.map(plain).join(" ");
        let mut lines = Lines::new();
        line(&mut lines, "scene", self.scene.to_owned());
        line(&mut lines, "method", self.how());
        line(&mut lines, "size", format!("{width} x {height}"));
        line(&mut lines, "shading", format!("{}, samples: {}", self.shading.0.name(), self.shading.1));
        line(&mut lines, "distance", format!("{} radii", plain(radii)));
        line(&mut lines, "eye", vector(eye.to_array()));
        line(&mut lines, "target", vector(target.to_array()));
        line(&mut lines, "up", vector(up.to_array()));
        line(&mut lines, "view angle", format!("{} degrees", plain(fov)));
        lines.extend(self.figures());
        lines
    }

    fn figures(&self) -> Lines {
        let stats = self.stats;
        let per_ray = |n: u64| format!("{:.2}", n as f64 / stats.rays as f64);
        let mut lines = Lines::new();
        line(&mut lines, "rays", grouped(stats.rays));
        line(&mut lines, "hits", grouped(stats.hits));
        line(&mut lines, "mean level", format!("{:.3}", stats.mean_level));
        if !stats.lines.is_empty() {
            line(&mut lines, "lines per ray", per_ray(stats.lines_read()));
            line(&mut lines, "distinct lines", grouped(stats.distinct_lines()));
            line(&mut lines, "nodes per ray", per_ray(stats.nodes));
            line(&mut lines, "LOD tests/ray", per_ray(stats.lod_tests));
            line(&mut lines, "triangles/ray", per_ray(stats.triangles));
        }
        if let Some((against, error)) = self.error {
            line(&mut lines, "compared with", against.name().to_owned());
            line(&mut lines, "RMSE", format!("{:.3} of 255", error.image.rmse));
            line(&mut lines, "PSNR", error.image.psnr_db.map_or("infinite".to_owned(), |p| format!("{p:.2} dB")));
            line(&mut lines, "pixels differing", format!("{:.2} %", 100.0 * error.image.differing));
            line(&mut lines, "coverage differs", format!("{} pixels", grouped(error.coverage_differs)));
            if let Some(off) = error.geometry_pixels {
                line(&mut lines, "surface off by", format!("{:.3} pixels", off.mean));
                line(&mut lines, "99 of 100 below", format!("{:.3} pixels", off.percentile_99));
            } else {
                line(&mut lines, "surfaces", "do not overlap".to_owned());
            }
        }
        lines
    }
}

fn capital(text: &str) -> String {
    let mut rest = text.chars();
    rest.next().map_or_else(String::new, |first| first.to_uppercase().chain(rest).collect())
}
