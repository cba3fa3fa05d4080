//! One ray's waveform from the model and from the RTL: equal in every signal of the model's, in every cycle.

use crate::port::{RESET, Rtl};
use lodray::hardware::Hardware;
use lodray::method::lod::LodImage;
use lodray::num::{Ray, VertexForm};
use lodray::sim::unit::wave::{PERIOD, Waves, one_ray};
use lodray::sim::unit::{SceneMemory, TraversalUnit};
use lodray_test_support::is_nightly;
use lodray_test_support::models::{any_rays, ball, scene_of, terrain, with_vertices};
use std::collections::BTreeMap;
use std::io::BufReader;
use vcd::{Command, IdCode, Parser, ScopeItem, Value, VarType};

/// Values of every signal by path, one per cycle.
struct Waveform(BTreeMap<String, Vec<Vec<Value>>>);

/// Generate blocks of the RTL around what hardware can lack: the model has no such scopes.
const OPTIONAL: [&str; 9] =
    ["g_place", "g_morphed", "g_deciders", "g_lod_test", "g_lod_test_by", "g_tessellate", "g_tri_test", "g_start_test", "g_bary_map"];

fn paths(items: &[ScopeItem], within: &str, to: &mut Vec<(String, IdCode, usize)>) {
    for item in items {
        match item {
            // Names stand beside what the RTL has.
            ScopeItem::Var(var) if var.var_type == VarType::String => (),
            ScopeItem::Var(var) => to.push((format!("{within}{}", var.reference), var.code, var.size as usize)),
            ScopeItem::Scope(scope) if OPTIONAL.contains(&&*scope.identifier) => paths(&scope.items, within, to),
            ScopeItem::Scope(scope) => paths(&scope.items, &format!("{within}{}.", scope.identifier), to),
            _ => (),
        }
    }
}

impl Waveform {
    /// Reads the signals that are `wanted`; cycle c is what stands at the end of its time from `PERIOD` (c + `first`) on.
    fn read(bytes: &[u8], first: u64, cycles: u64, wanted: impl Fn(&str) -> bool) -> Self {
        let mut parser = Parser::new(BufReader::new(bytes));
        let header = parser.parse_header().expect("a VCD header");
        let mut signals = Vec::new();
        paths(&header.items, "", &mut signals);
        signals.retain(|(path, ..)| wanted(path));
        let widths: BTreeMap<IdCode, usize> = signals.iter().map(|(_, code, width)| (*code, *width)).collect();
        let mut now: BTreeMap<IdCode, Vec<Value>> = widths.iter().map(|(code, width)| (*code, vec![Value::X; *width])).collect();
        let mut all: BTreeMap<IdCode, Vec<Vec<Value>>> = BTreeMap::new();
        let mut taken = 0;
        for command in parser {
            match command.expect("a VCD command") {
                Command::Timestamp(time) => {
                    // All changes before this time are in `now`.
                    while taken < cycles && time >= PERIOD * (first + taken + 1) {
                        now.iter().for_each(|(code, value)| all.entry(*code).or_default().push(value.clone()));
                        taken += 1;
                    }
                }
                Command::ChangeScalar(code, value) if now.contains_key(&code) => {
                    now.insert(code, vec![value]);
                }
                Command::ChangeVector(code, vector) if now.contains_key(&code) => {
                    let bits: Vec<Value> = vector.iter().collect();
                    // A vector may come without its leading zeros.
                    let fill = if bits.first() == Some(&Value::X) { Value::X } else { Value::V0 };
                    let missing = widths[&code] - bits.len();
                    now.insert(code, [vec![fill; missing], bits].concat());
                }
                _ => (),
            }
        }
        assert_eq!(taken, cycles, "the waveform ends early");
        Self(signals.into_iter().map(|(path, code, _)| (path, all[&code].clone())).collect())
    }
}

/// Compares the waveforms of one ray; gives signals, cycles and bits compared.
fn compare(config: Hardware, memory: &SceneMemory<'_>, latency: u32, ray: &Ray, seed: u64) -> (usize, u64, u64) {
    let mut model = Waves::new(TraversalUnit::new(config, memory.config())).expect("a waveform");
    let expected = one_ray(&mut model, memory, latency, ray).expect("a ray");
    let cycles = model.cycles();
    let model = Waveform::read(&model.finish().expect("a waveform"), 0, cycles, |path| !path.ends_with("clk_i"));

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("ray.vcd");
    let mut rtl = Rtl::new(config, &memory.config(), seed);
    rtl.sim.open_vcd(&path).expect("a waveform");
    assert_eq!(one_ray(&mut rtl, memory, latency, ray).expect("a ray"), expected);
    rtl.sim.clock();
    rtl.sim.close_vcd();
    let rtl = Waveform::read(&std::fs::read(&path).expect("a waveform"), RESET, cycles, |path| model.0.contains_key(path));

    let mut bits = 0;
    for (signal, values) in &model.0 {
        let other = rtl.0.get(signal).unwrap_or_else(|| panic!("the RTL has no signal {signal}"));
        for (cycle, (a, b)) in values.iter().zip(other).enumerate() {
            assert_eq!(a.len(), b.len(), "{signal}");
            let same = a.iter().zip(b).all(|(a, b)| *a == Value::X || a == b);
            let text = |v: &[Value]| v.iter().map(ToString::to_string).collect::<String>();
            assert!(same, "{signal}, cycle {cycle}, seed {seed}:\nmodel {}\nRTL   {}", text(a), text(b));
            bits += a.iter().filter(|v| **v != Value::X).count() as u64;
        }
    }
    (model.0.len(), cycles, bits)
}

#[test]
fn the_waveforms_of_model_and_rtl_are_equal() {
    let rays = if is_nightly() { 8 } else { 4 };
    let (mut signals, mut cycles, mut bits) = (0, 0, 0);
    let compact = |h| with_vertices(VertexForm::Compact, h);
    for (number, h) in [compact(ball(4, 0.4, 1)), terrain(2, 2, 0.4, 2), ball(0, 0.4, 3), compact(ball(1, 0.4, 4))].iter().enumerate() {
        let scene = scene_of(h);
        let memory = SceneMemory::new(LodImage::of(&scene), 0);
        // Of primary rays, in hardware for them alone and for others too.
        let hardware = [false, true].map(|secondary| Hardware { secondary, ..Hardware::one_context() });
        for (ray, config) in any_rays(h, rays, number as u64).iter().zip(hardware.into_iter().cycle()) {
            let (s, c, b) = compare(config, &memory, 17, ray, number as u64 + 1);
            (signals, cycles, bits) = (s, cycles + c, bits + b);
        }
    }
    println!("{signals} signals, {cycles} cycles, {bits} bits compared");
    assert!(bits > 1_000_000);
}
