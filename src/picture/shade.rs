//! Pictures from frames: shaded, normals, level-of-detail map, error map.

use super::Frame;
use super::shading::{BACKGROUND, Light, Shader};
use crate::format::{Scene, to_srgb};
use crate::method::SurfaceHit;
use crate::rays::Camera;
use glam::{DVec3, Vec3};
use image::{Rgb, RgbImage};
use rayon::prelude::*;

/// Colours of levels 0 to 10, coarse to fine, linear: blue, green, yellow, red, white.
const LEVELS: [[f32; 3]; 11] = [
    [0.03, 0.05, 0.35],
    [0.03, 0.15, 0.65],
    [0.02, 0.40, 0.70],
    [0.02, 0.50, 0.35],
    [0.10, 0.55, 0.08],
    [0.45, 0.60, 0.03],
    [0.85, 0.55, 0.03],
    [0.90, 0.25, 0.03],
    [0.80, 0.06, 0.08],
    [0.75, 0.10, 0.45],
    [0.85, 0.75, 0.85],
];

/// Headlight shading with the material's colour, sRGB; the picture is as large as the frame, every ray being a pixel's only one.
pub fn shaded(frame: &Frame, shader: &Shader<'_>, camera: &Camera) -> RgbImage {
    shaded_by(frame, camera, |_| shader)
}

/// The same where each pixel, by its number, has a shader of its own.
pub fn shaded_by<'a>(frame: &Frame, camera: &Camera, shader: impl Fn(usize) -> &'a Shader<'a> + Sync) -> RgbImage {
    paint(frame, |index, pixel| {
        let (x, y) = (index as u32 % camera.width, index as u32 / camera.width); // below 2^16 each
        let mut light = Light::default();
        shader(index).add(&mut light, &camera.ray(x, y), pixel.as_ref());
        light.mean()
    })
}

/// |n.d| at pixel number `index` of a frame: full-resolution shading normal against the view direction.
pub fn view_cosine(scene: &Scene, camera: &Camera, index: usize, pixel: &SurfaceHit) -> f32 {
    cosine_to(pixel.normal(scene), camera, index)
}

/// |n.d| of a unit normal at pixel number `index`.
pub fn cosine_to(normal: Vec3, camera: &Camera, index: usize) -> f32 {
    let (x, y) = (index as u32 % camera.width, index as u32 / camera.width); // below 2^16 each
    let view = DVec3::from_array(camera.ray(x, y).direction).as_vec3();
    normal.dot(view).abs()
}

/// Full-resolution normals as colours, (n + 1) / 2.
pub fn normal_map(frame: &Frame, scene: &Scene) -> RgbImage {
    normal_map_by(frame, |_, pixel| pixel.normal(scene))
}

/// The same by the unit normals that `normal` gives of pixels, by their numbers and hits.
pub fn normal_map_by(frame: &Frame, normal: impl Fn(usize, &SurfaceHit) -> Vec3 + Sync) -> RgbImage {
    map(frame, |index, pixel| match pixel {
        Some(pixel) => normal_colour(normal(index, pixel)),
        None => Rgb([0, 0, 0]),
    })
}

/// Colour of a unit normal.
pub(super) fn normal_colour(normal: Vec3) -> Rgb<u8> {
    bytes((normal + 1.0) * 0.5)
}

/// Level of each pixel's triangle as a colour, the triangles told apart by brightness.
pub fn level_map(frame: &Frame) -> RgbImage {
    paint(frame, |_, pixel| {
        let Some(pixel) = pixel else { return BACKGROUND };
        let mixed =
            (u64::from(pixel.tree) << 24 ^ u64::from(pixel.level) << 20 ^ u64::from(pixel.node)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        level(u32::from(pixel.level), (mixed >> 40) as f32 / (1u32 << 24) as f32)
    })
}

/// Linear colour of a level, `shade` of 0 to 1 being its darkest to its brightest.
fn level(level: u32, shade: f32) -> Vec3 {
    Vec3::from_array(LEVELS[level as usize % LEVELS.len()]) * (0.55 + 0.45 * shade)
}

/// The colour of a level in [`level_map`], `shade` of 0 to 1 being its darkest to its brightest.
pub fn level_colour(of: u32, shade: f32) -> Rgb<u8> {
    encoded(level(of, shade))
}

/// Largest difference of a pixel's channels as heat.
pub fn error_map(a: &RgbImage, b: &RgbImage) -> RgbImage {
    let mut out = RgbImage::new(a.width(), a.height());
    for ((out, a), b) in out.pixels_mut().zip(a.pixels()).zip(b.pixels()) {
        let difference = (0..3).map(|k| a.0[k].abs_diff(b.0[k])).max().unwrap_or(0);
        *out = heat(f32::from(difference));
    }
    out
}

/// The difference that is white; larger ones are, too.
pub const HOTTEST: u32 = 64;

/// Colour of a difference: black 0, through red and yellow, white [`HOTTEST`] of 255 and more.
pub(super) fn heat(difference: f32) -> Rgb<u8> {
    let heat = 3.0 * (difference / HOTTEST as f32).min(1.0);
    bytes(Vec3::new(heat, heat - 1.0, heat - 2.0))
}

fn map(frame: &Frame, colour: impl Fn(usize, &Option<SurfaceHit>) -> Rgb<u8> + Sync) -> RgbImage {
    let bytes: Vec<u8> = frame.pixels.par_iter().enumerate().flat_map_iter(|(i, p)| colour(i, p).0).collect();
    RgbImage::from_raw(frame.width, frame.height, bytes).expect("three bytes for each pixel")
}

/// Like [`map`] with linear colours.
fn paint(frame: &Frame, colour: impl Fn(usize, &Option<SurfaceHit>) -> Vec3 + Sync) -> RgbImage {
    map(frame, |i, p| encoded(colour(i, p)))
}

/// A linear colour in sRGB.
pub(super) fn encoded(colour: Vec3) -> Rgb<u8> {
    Rgb(colour.to_array().map(to_srgb))
}

fn bytes(c: Vec3) -> Rgb<u8> {
    // Clamped to a byte before the cast.
    Rgb((c.clamp(Vec3::ZERO, Vec3::ONE) * 255.0).round().to_array().map(|v| v as u8))
}
