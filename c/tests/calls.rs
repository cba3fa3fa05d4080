//! What callers can do wrong gives one clear error and nothing else, and what is cast, packed and stepped is the same by every way.

use lodray_c::bits::*;
use lodray_c::cast::*;
use lodray_c::config::*;
use lodray_c::error::*;
use lodray_c::golden::*;
use lodray_c::ports::*;
use lodray_c::rays::*;
use lodray_c::scene::*;
use lodray_c::unit::*;
use std::ffi::CStr;
use std::mem::zeroed;
use std::ptr::{null, null_mut};

/// Why the last call failed.
fn why() -> String {
    // SAFETY: the text is this thread's, and no call comes in between.
    unsafe { CStr::from_ptr(lodray_last_error()) }.to_string_lossy().into_owned()
}

/// A small scene; the caller closes it.
fn sphere() -> *mut LodrayScene {
    // SAFETY: the name ends with a zero byte.
    let scene = unsafe { lodray_scene_generate(c"sphere".as_ptr(), 3, 32, 0) };
    assert!(!scene.is_null(), "{}", why());
    scene
}

const SIDE: u32 = 20;
const RAYS: usize = (SIDE * SIDE) as usize;

/// A picture's rays.
fn rays(scene: *mut LodrayScene) -> Vec<LodrayRay> {
    // SAFETY: a ray of zeros is one.
    let mut rays = vec![unsafe { zeroed::<LodrayRay>() }; RAYS];
    // SAFETY: the scene is open, and there is room for all.
    assert_eq!(unsafe { lodray_camera_rays(scene, 2.0, SIDE, SIDE, rays.as_mut_ptr()) }, LODRAY_OK, "{}", why());
    rays
}

#[test]
fn what_cannot_be_is_said_and_null_is_survived() {
    let scene = sphere();
    let mut ray = rays(scene)[0];
    // SAFETY: what is not null here is what the header asks for, and null is refused.
    unsafe {
        assert!(lodray_scene_open(null()).is_null() && why() == "path: a null pointer", "{}", why());
        assert!(lodray_scene_open(c"/no/such.lod".as_ptr()).is_null() && why().contains("/no/such.lod"), "{}", why());
        assert!(lodray_scene_open(c"\xff".as_ptr()).is_null() && why().contains("UTF-8"), "{}", why());
        assert!(lodray_scene_generate(c"cube".as_ptr(), -1, -1, 0).is_null() && why().contains("terrain"), "{}", why());
        assert!(lodray_scene_generate(c"sphere".as_ptr(), 11, -1, 0).is_null() && why().contains("10"), "{}", why());
        assert!(lodray_method_new(scene, c"magic".as_ptr(), null()).is_null() && why().contains("there is no method 'magic'"), "{}", why());
        assert!(lodray_method_new(scene, c"lod".as_ptr(), c"delta".as_ptr()).is_null() && why().contains("NAME=VALUE"), "{}", why());
        assert!(lodray_method_new(scene, c"lod".as_ptr(), c"delta=-1".as_ptr()).is_null() && why().contains("delta"), "{}", why());
        let method = lodray_method_new(scene, c"lod".as_ptr(), c"delta=1".as_ptr());
        assert_eq!(lodray_method_cast(method, &raw const ray, 1, null_mut()), LODRAY_ERROR);
        assert_eq!(why(), "hits: a null pointer");
        assert_eq!(lodray_method_cast(method, null(), 0, null_mut()), LODRAY_OK, "no rays need no place");
        let mut hit: LodrayHit = zeroed();
        assert_eq!(lodray_method_cast(method, &raw const ray, u64::MAX, &raw mut hit), LODRAY_ERROR);
        assert!(why().contains("at most"), "{}", why());
        ray.direction = [0.0; 3];
        assert_eq!(lodray_method_cast(method, &raw const ray, 1, &raw mut hit), LODRAY_ERROR);
        assert_eq!(why(), "ray 0: the direction has no length");
        let mut in_i = LodrayRayIn::default();
        assert_eq!(lodray_ray_enter(scene, &raw const ray, 1.0, 0, &raw mut in_i, null_mut()), LODRAY_ERROR);
        ray.direction = [0.0, 0.0, 1.0];
        assert_eq!(lodray_ray_enter(scene, &raw const ray, f64::NAN, 0, &raw mut in_i, null_mut()), LODRAY_ERROR);
        assert_eq!(why(), "delta: NaN is not from 0 to infinity");
        assert_eq!(lodray_camera_rays(scene, 2.0, 0, 5, null_mut()), LODRAY_ERROR);
        assert_eq!(lodray_camera_ray_bits(scene, 2.0, 1.0, 8, 8, 8, 0, [0; LODRAY_RAY_IN_WORDS].as_mut_ptr()), LODRAY_ERROR);
        assert_eq!(why(), "pixel (8, 0) is outside of 8 x 8");
        lodray_method_end(method);
        lodray_method_end(null_mut());
        lodray_golden_end(null_mut());
        lodray_unit_end(null_mut());
        lodray_scene_close(null_mut());
        lodray_scene_close(scene);
    }
}

#[test]
fn golden_and_the_method_cast_the_same() {
    let scene = sphere();
    let rays = rays(scene);
    // SAFETY: handles are alive until they are ended below, and there is room for as many as there are rays; structs of numbers may be all 0.
    unsafe {
        let (method, golden) = (lodray_method_new(scene, c"lod".as_ptr(), c"delta=1".as_ptr()), lodray_golden_new(scene));
        // What is made of a scene outlives it.
        lodray_scene_close(scene);
        let (mut cast, mut wanted) = (vec![zeroed::<LodrayHit>(); RAYS], vec![zeroed::<LodrayGoldenHit>(); RAYS]);
        let (mut any, mut met) = ([2; RAYS], [2; RAYS]);
        assert_eq!(lodray_method_cast(method, rays.as_ptr(), RAYS as u64, cast.as_mut_ptr()), LODRAY_OK, "{}", why());
        assert_eq!(lodray_golden_cast(golden, rays.as_ptr(), RAYS as u64, 1.0, wanted.as_mut_ptr()), LODRAY_OK, "{}", why());
        assert_eq!(lodray_method_cast_any(method, rays.as_ptr(), RAYS as u64, any.as_mut_ptr()), LODRAY_OK, "{}", why());
        assert_eq!(lodray_golden_cast_any(golden, rays.as_ptr(), RAYS as u64, 1.0, met.as_mut_ptr()), LODRAY_OK, "{}", why());
        let golden_rows: Vec<_> = wanted.iter().map(|wanted| wanted.hit).collect();
        for (ray, (cast, golden)) in cast.iter().zip(&golden_rows).enumerate() {
            // As text, where no number is like any other.
            assert_eq!(format!("{cast:?}"), format!("{golden:?}"), "ray {ray}");
        }
        assert_eq!(any, met);
        assert!(wanted.iter().zip(met).all(|(hit, met)| hit.out_o.found == met && (met == 1) == hit.hit.t.is_finite()));
        assert!(met.iter().map(|&met| usize::from(met)).sum::<usize>() > 100);

        let entered: Vec<_> = wanted.iter().filter(|wanted| wanted.entered == 1).collect();
        let (in_i, expected): (Vec<_>, Vec<_>) = entered.iter().map(|wanted| (wanted.in_i, wanted.out_o)).unzip();
        let mut out = vec![LodrayHitOut::default(); in_i.len()];
        assert_eq!(lodray_golden_trace(golden, in_i.as_ptr(), null(), in_i.len() as u64, out.as_mut_ptr()), LODRAY_OK, "{}", why());
        assert_eq!(out, expected);
        // A range that ends before the first hit.
        let met = expected.iter().position(|hit| hit.found == 1).unwrap();
        let mut range = LodraySecondaryIn { t_max: expected[met].t - 1, ..LodraySecondaryIn::default() };
        assert_eq!(lodray_golden_trace(golden, &raw const in_i[met], &raw const range, 1, out.as_mut_ptr()), LODRAY_OK, "{}", why());
        assert_eq!(out[0], LodrayHitOut { tag: in_i[met].tag, ..LodrayHitOut::default() });
        range.fraction = [0, 1, 0];
        assert_eq!(lodray_golden_trace(golden, &raw const in_i[met], &raw const range, 1, out.as_mut_ptr()), LODRAY_ERROR);
        assert!(why().contains("start on a surface"), "{}", why());
        let mut wide = in_i[met];
        wide.ray.cone_slope = 1 << 18;
        assert_eq!(lodray_golden_trace(golden, &raw const wide, null(), 1, out.as_mut_ptr()), LODRAY_ERROR);
        assert_eq!(why(), "in_i[0].ray.cone_slope: 262144 does not fit 18 bits");
        lodray_golden_end(golden);
        lodray_method_end(method);
    }
}

#[test]
fn bits_are_the_structs() {
    let scene = sphere();
    // SAFETY: the handle is alive until it is closed below, and every array has as many words as the header says.
    unsafe {
        let golden = lodray_golden_new(scene);
        let (mut rays, mut hits) = ([0; LODRAY_RAY_IN_WORDS], [0; LODRAY_HIT_OUT_WORDS]);
        let (x, y) = (SIDE / 2, SIDE / 2);
        assert_eq!(lodray_camera_ray_bits(scene, 2.0, 1.0, SIDE, SIDE, x, y, rays.as_mut_ptr()), 1, "{}", why());
        assert_eq!(lodray_golden_trace_bits(golden, rays.as_ptr(), hits.as_mut_ptr()), LODRAY_OK, "{}", why());
        let (mut ray, mut hit, mut expected) = (LodrayRayIn::default(), LodrayHitOut::default(), LodrayHitOut::default());
        assert_eq!(lodray_ray_in_from_bits(rays.as_ptr(), &raw mut ray), LODRAY_OK);
        assert_eq!(lodray_hit_out_from_bits(hits.as_ptr(), &raw mut hit), LODRAY_OK);
        assert_eq!(lodray_golden_trace(golden, &raw const ray, null(), 1, &raw mut expected), LODRAY_OK);
        assert!(hit == expected && hit.found == 1 && hit.tag == y * SIDE + x, "{hit:?} {expected:?}");
        let mut again = ([0; LODRAY_RAY_IN_WORDS], [0; LODRAY_HIT_OUT_WORDS]);
        assert_eq!(lodray_ray_in_to_bits(&raw const ray, again.0.as_mut_ptr()), LODRAY_OK);
        assert_eq!(lodray_hit_out_to_bits(&raw const hit, again.1.as_mut_ptr()), LODRAY_OK);
        assert_eq!(again, (rays, hits));

        // A memory line, and requests and answers as words.
        let mut config = LodraySceneConfig::default();
        assert_eq!(lodray_scene_config(scene, &raw mut config), LODRAY_OK, "{}", why());
        let (mut line, mut line_bits) = ([0; 4], [0; LODRAY_LINE_WORDS]);
        assert_eq!(lodray_scene_line(scene, config.nodes, line.as_mut_ptr()), 1);
        assert_eq!(lodray_line_bits(scene, config.nodes, line_bits.as_mut_ptr()), 1);
        assert!(
            line != [0; 4]
                && line.iter().zip(line_bits.chunks(2)).all(|(word, halves)| *word == u64::from(halves[1]) << 32 | u64::from(halves[0]))
        );
        let mut bytes = 0;
        let image = lodray_scene_image(scene, &raw mut bytes);
        assert_eq!(image.add(32 * config.nodes as usize).cast::<[u8; 8]>().read(), line[0].to_le_bytes());
        for beyond in [bytes / 32, u64::MAX] {
            assert_eq!((lodray_scene_line(scene, beyond, line.as_mut_ptr()), line), (0, [0; 4]));
        }
        let answer = LodrayMemoryAnswer { tag: 0xa5, epoch: 0x3c, error: 1, line: [1, 2, 3, u64::MAX] };
        let mut answer_bits = [0; LODRAY_MEMORY_ANSWER_WORDS];
        assert_eq!(lodray_memory_answer_to_bits(&raw const answer, answer_bits.as_mut_ptr()), LODRAY_OK);
        // Word 3 of the line stands above word 0, then error, epoch and tag.
        assert_eq!((answer_bits[0], answer_bits[7], answer_bits[8]), (1, u32::MAX, 0xa5 << 9 | 0x3c << 1 | 1));
        let mut request = LodrayMemoryRequest::default();
        assert_eq!(lodray_memory_request_from_bits([7, 0xa5 << 12 | 0x3c << 4].as_ptr(), &raw mut request), LODRAY_OK);
        assert_eq!(request, LodrayMemoryRequest { tag: 0xa5, epoch: 0x3c, address: 7 }, "tag, epoch and 36 bits of line");
        let mut config_bits = [0; LODRAY_SCENE_CONFIG_WORDS];
        assert_eq!(lodray_scene_config_bits(scene, config_bits.as_mut_ptr()), LODRAY_OK);
        assert_eq!(config_bits[0] & 0xf_ffff, config.answer_limit);
        let secondary = LodraySecondaryIn { t_max: LODRAY_T_MAX + 1, ..LodraySecondaryIn::default() };
        assert_eq!(lodray_secondary_in_to_bits(&raw const secondary, [0; LODRAY_SECONDARY_IN_WORDS].as_mut_ptr()), LODRAY_ERROR);
        assert_eq!(why(), "secondary.t_max: 34359738368 does not fit 35 bits");
        lodray_golden_end(golden);
        lodray_scene_close(scene);
    }
}

#[test]
fn a_unit_is_stepped_and_what_is_no_unit_is_refused() {
    let scene = sphere();
    // SAFETY: handles are alive until they are ended below, structs are such.
    unsafe {
        let mut config = LodraySceneConfig::default();
        assert_eq!(lodray_scene_config(scene, &raw mut config), LODRAY_OK, "{}", why());
        for (hardware, words) in [
            (LodrayHardware { contexts: 65, ..LodrayHardware::default() }, "contexts must be 1 to 64, but is 65"),
            (LodrayHardware { edges_per_cycle: 2, ..LodrayHardware::default() }, "edges_per_cycle must be 1 or 3, but is 2"),
        ] {
            assert!(lodray_unit_begin(&raw const config, &raw const hardware).is_null() && why().contains(words), "{}", why());
        }
        let deep = LodraySceneConfig { levels: 16, ..config };
        assert!(lodray_unit_begin(&raw const deep, null()).is_null() && why() == "config.levels: 16 does not fit 4 bits", "{}", why());

        let one = LodrayHardware { contexts: 1, ..LodrayHardware::default() };
        let unit = lodray_unit_begin(&raw const config, &raw const one);
        let (mut inputs, mut outputs) = (LodrayInputs::default(), LodrayOutputs::default());
        let mut look = || {
            assert_eq!(lodray_unit_outputs(unit, &raw mut outputs), LODRAY_OK);
            outputs
        };
        assert_eq!(look(), LodrayOutputs { ready_o: 1, ..LodrayOutputs::default() });
        inputs.valid_i = 1;
        inputs.in_i.ray.cone_shift = 64;
        assert_eq!(lodray_unit_step(unit, &raw const inputs), LODRAY_ERROR);
        assert!(why() == "in_i.ray.cone_shift: 64 does not fit 6 bits" && look().busy_o == 0, "nothing has happened: {}", why());
        inputs.in_i = LodrayRayIn { tag: 9, ray: LodrayModelRay { direction: [0, 0, 1 << 29], ..LodrayModelRay::default() } };
        assert_eq!(lodray_unit_step(unit, &raw const inputs), LODRAY_OK, "{}", why());
        assert_eq!((look().ready_o, look().busy_o), (0, 1), "its one context has the ray");
        assert_eq!((lodray_unit_scene(unit, &raw const config), why().as_str()), (LODRAY_ERROR, "config: rays are under way"));
        // An answer that nobody waits for, from a context that is not there.
        inputs =
            LodrayInputs { mem_valid_i: 1, mem_i: LodrayMemoryAnswer { tag: 255, ..Default::default() }, ready_i: 1, ..Default::default() };
        assert_eq!(lodray_unit_step(unit, &raw const inputs), LODRAY_OK, "{}", why());
        // A flush ends the ray with an error, and its tag.
        inputs = LodrayInputs { flush_i: 1, ready_i: 1, mem_ready_i: 1, ..Default::default() };
        let hit = (0..200).find_map(|_| {
            assert_eq!(lodray_unit_step(unit, &raw const inputs), LODRAY_OK, "{}", why());
            Some(look()).filter(|outputs| outputs.valid_o == 1)
        });
        assert_eq!(hit.unwrap().out_o, LodrayHitOut { tag: 9, error: 7, ..LodrayHitOut::default() });
        assert_eq!(lodray_unit_reset(unit), LODRAY_OK);
        assert_eq!(look(), LodrayOutputs { ready_o: 1, ..LodrayOutputs::default() });
        assert_eq!(lodray_unit_scene(unit, &raw const config), LODRAY_OK);
        lodray_unit_end(unit);
        lodray_scene_close(scene);
    }
}
