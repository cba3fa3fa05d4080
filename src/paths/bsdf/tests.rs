//! Energy and both ways alike, of all materials.

use super::*;
use crate::paths::random::share;

const WHITE: [f64; 3] = [1.0; 3];
const AT: Place = Place { colour: DVec3::ONE, normal: DVec3::Z, front: true };

/// Paths of a furnace; `LODRAY_PATHS` takes more.
fn count() -> u32 {
    std::env::var("LODRAY_PATHS").ok().and_then(|text| text.parse().ok()).unwrap_or(20_000)
}

fn view(cosine: f64) -> DVec3 {
    DVec3::new((1.0f64 - cosine * cosine).sqrt(), 0.0, cosine)
}

/// Materials that swallow nothing.
fn white() -> Vec<(String, Material)> {
    let mut all = vec![
        ("diffuse".to_owned(), Material::Diffuse { albedo: Some(WHITE) }),
        ("mirror".to_owned(), Material::Mirror { reflectance: WHITE }),
        ("glass".to_owned(), Material::Glass { index: 1.5, roughness: 0.0 }),
    ];
    for roughness in [0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0] {
        all.push((format!("glossy {roughness}"), Material::Glossy { reflectance: WHITE, roughness, albedo: [0.0; 3] }));
        all.push((format!("coated {roughness}"), Material::Glossy { reflectance: [0.04, 0.3, 0.8], roughness, albedo: WHITE }));
        all.push((format!("glass {roughness}"), Material::Glass { index: 1.5, roughness }));
    }
    all
}

/// Energy of a scattered ray: radiance in a body is by the square of its index more.
fn energy(scatter: &Scatter, material: &Material, front: bool) -> DVec3 {
    let square = match *material {
        Material::Glass { index, .. } if scatter.direction.z < 0.0 => {
            if front {
                index * index
            } else {
                1.0 / (index * index)
            }
        }
        _ => 1.0,
    };
    scatter.weight * square
}

#[test]
fn nothing_is_lost_and_nothing_gained_in_a_furnace() {
    let n = count();
    for (name, material) in white() {
        let bsdf = Bsdf::of(&material);
        for front in [true, false] {
            let at = Place { front, ..AT };
            for cosine in [0.1, 0.3, 0.6, 1.0] {
                let mut random = Random::new(11);
                let samples =
                    (0..n).map(|_| bsdf.sample(&at, view(cosine), &mut random).map_or(DVec3::ZERO, |s| energy(&s, &material, front)));
                let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
                for own in samples {
                    sum += own;
                    squares += own * own;
                }
                let mean = sum / f64::from(n);
                let error = ((squares / f64::from(n) - mean * mean).max(DVec3::ZERO) / f64::from(n)).map(f64::sqrt).max_element();
                let off = (mean - DVec3::ONE).abs().max_element();
                assert!(off <= 0.005 + 3.0 * error, "{name}, cosine {cosine}, front {front}: {mean} +- {error}");
            }
        }
    }
}

/// Samples come as often as their likelihood says: the mean over samples is the integral of values, whichever way it is taken.
#[test]
fn samples_have_the_likelihood_that_is_said() {
    let n = 10 * count();
    let coloured = Material::Glossy { reflectance: [0.9, 0.5, 0.04], roughness: 0.6, albedo: [0.0, 0.3, 0.8] };
    let glass = Material::Glass { index: 1.5, roughness: 0.6 };
    for material in [coloured, glass, Material::Diffuse { albedo: Some([0.2, 0.5, 1.0]) }] {
        let bsdf = Bsdf::of(&material);
        for front in [true, false] {
            let at = Place { front, ..AT };
            for cosine in [0.2, 0.7, 1.0] {
                let mut random = Random::new(3);
                let (mut by_samples, mut evenly, mut whole) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2], 0.0);
                for _ in 0..n {
                    if let Some(scatter) = bsdf.sample(&at, view(cosine), &mut random) {
                        by_samples[usize::from(scatter.direction.z < 0.0)] += scatter.weight / f64::from(n);
                    }
                    let up = cosine_direction(DVec3::Z, &mut random);
                    for (side, direction) in [up, -up].into_iter().enumerate() {
                        let (value, pdf) = bsdf.eval(&at, view(cosine), direction);
                        evenly[side] += value / cosine_pdf(up.z) / f64::from(n);
                        whole += pdf / cosine_pdf(up.z) / f64::from(n);
                    }
                }
                for side in 0..2 {
                    let off = (by_samples[side] - evenly[side]).abs().max_element();
                    assert!(off < 0.02 * (1.0 + evenly[side].max_element()), "{material:?} {front} {cosine}: {by_samples:?} {evenly:?}");
                }
                assert!(whole <= 1.01, "{material:?} {front} {cosine}: {whole}");
            }
        }
    }
}

/// f(a, b) = f(b, a), and through a boundary with the squares of the indices.
#[test]
fn all_are_the_same_both_ways() {
    let mut random = Random::new(4);
    let mut pairs = 0;
    for (name, material) in white() {
        let bsdf = Bsdf::of(&material);
        for _ in 0..200 {
            let a = cosine_direction(DVec3::Z, &mut random);
            let up = cosine_direction(DVec3::Z, &mut random);
            let goes_through = bsdf.is_clear() && share(&mut random) < 0.5;
            let there = bsdf.eval(&AT, a, if goes_through { -up } else { up }).0 / up.z;
            let (back, square) = match material {
                // From inside the normal is turned.
                Material::Glass { index, .. } if goes_through => {
                    let turned = Place { normal: DVec3::NEG_Z, front: false, ..AT };
                    (bsdf.eval(&turned, -up, a).0 / a.z, index * index)
                }
                _ => (bsdf.eval(&AT, up, a).0 / a.z, 1.0),
            };
            // Values are by the square of the index of the side that light goes to.
            let off = (there - back / square).abs().max_element();
            assert!(off <= 1e-6 * there.max_element() + 1e-12, "{name}: {there} {back}");
            pairs += 1;
        }
    }
    assert!(pairs > 5_000);
}

#[test]
fn a_mirror_mirrors_and_glass_bends() {
    let mut random = Random::new(4);
    let mirror = Bsdf::of(&Material::Mirror { reflectance: [0.5; 3] });
    let scatter = mirror.sample(&AT, view(0.6), &mut random).unwrap();
    assert!((scatter.direction - DVec3::new(-0.8, 0.0, 0.6)).length() < 1e-12 && scatter.pdf.is_none());
    assert!(mirror.sample(&AT, -view(0.6), &mut random).is_none());
    let glass = Bsdf::of(&Material::Glass { index: 1.5, roughness: 0.0 });
    let inside = Place { front: false, ..AT };
    let (mut through, n) = (0, 10_000);
    for _ in 0..n {
        let scatter = glass.sample(&AT, view(0.6), &mut random).unwrap();
        if let Lobe::Through { eta } = scatter.lobe {
            assert_eq!(eta, 1.5);
            assert!((scatter.direction.x + 0.8 / 1.5).abs() < 1e-12 && scatter.direction.z < 0.0);
            through += 1;
        }
        // Beyond the critical angle of 41.8 degrees all comes back.
        assert_eq!(glass.sample(&inside, view(0.6), &mut random).unwrap().lobe, Lobe::Mirror);
    }
    let wanted = 1.0 - facets::fresnel(0.6, 1.5);
    assert!((f64::from(through) / f64::from(n) - wanted).abs() < 0.02, "{through}");
}
