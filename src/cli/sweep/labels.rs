//! Labels of bars: what tells a chart's results apart, and nothing else.

use lodray::method::bvh::{LEAF_LAYOUT, LEAF_SIZE};
use lodray::method::knob::DELTA;
use lodray::report::result::SimResult;
use std::collections::HashMap;

/// Something in which results can differ, and how a label says it; nothing where it does not apply.
pub struct Setting {
    text: fn(&SimResult) -> String,
    /// Said even if it is the same for all.
    always: bool,
}

impl Setting {
    /// Of results on one machine.
    pub const OF_METHODS: &'static [Self] = &[
        Self { text: |r| r.setup.method.name.clone(), always: true },
        Self { text: |r| r.setup.method.delta.map_or_else(String::new, quality), always: false },
        Self { text: |r| r.setup.method.choices.values().cloned().collect::<Vec<_>>().join(" "), always: false },
        Self { text: |r| r.setup.method.leaves.clone().unwrap_or_default(), always: false },
    ];
    /// Of lines through views: what a method chooses by itself, another from view to view, is no setting.
    pub const OF_LINES: &'static [Self] = &[
        Self { text: |r| r.setup.method.name.clone(), always: true },
        Self { text: |r| r.setup.method.delta.map_or_else(String::new, quality), always: false },
        Self { text: others, always: false },
        Self { text: |r| r.setup.method.leaves.clone().unwrap_or_default(), always: false },
    ];
    /// Of results on several.
    pub const OF_MACHINES: &'static [Self] = &[
        Self { text: |r| r.setup.machine.label.clone(), always: false },
        Self { text: |r| r.setup.machine.set.join(" "), always: false },
        Self { text: |r| r.setup.compute.name().to_owned(), always: false },
    ];
}

/// Knobs that have no field of their own.
fn others(r: &SimResult) -> String {
    let said = [DELTA.name, LEAF_LAYOUT.name, LEAF_SIZE.name];
    let knobs = r.setup.method.knobs.iter().filter(|(name, _)| !said.contains(&name.as_str()));
    knobs.map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(" ")
}

fn quality(delta: f64) -> String {
    if delta.is_finite() { format!("δ{delta}") } else { "δ∞".to_owned() }
}

/// A label for each result. Of the settings those are said that tell apart what the ones before leave alike.
pub fn labels(results: &[&SimResult], settings: &[Setting]) -> Vec<String> {
    let mut said: Vec<Vec<String>> = vec![Vec::new(); results.len()];
    for setting in settings {
        let texts: Vec<_> = results.iter().map(|r| (setting.text)(r)).collect();
        let mut firsts: HashMap<&[String], &str> = HashMap::new();
        let differs = said.iter().zip(&texts).any(|(before, text)| *firsts.entry(before).or_insert(text) != text);
        drop(firsts);
        if setting.always || differs {
            said.iter_mut().zip(texts).for_each(|(said, text)| said.push(text));
        }
    }
    let label = |said: Vec<String>| said.into_iter().filter(|text| !text.is_empty()).collect::<Vec<_>>().join(" ");
    // A machine without changes beside changed ones of the same name says nothing.
    said.into_iter().map(label).map(|label| if label.is_empty() { "unchanged".to_owned() } else { label }).collect()
}
