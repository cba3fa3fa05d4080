//! What methods chose for the models of a scene.

use super::world::World;

/// Most values that are named of one choice.
const SHOWN: usize = 8;

impl World<'_> {
    /// What the method chose for all models, name and value; where it chose differently for some, the values that there are, in the order of the models.
    pub fn choices(&self) -> Vec<(&'static str, String)> {
        let mut all: Vec<(&'static str, Vec<String>)> = Vec::new();
        for (name, value) in self.instances().iter().flat_map(|own| own.method.choices(own.sight())) {
            match all.iter_mut().find(|(known, _)| *known == name) {
                Some((_, values)) if values.contains(&value) => {}
                Some((_, values)) => values.push(value),
                None => all.push((name, vec![value])),
            }
        }
        all.into_iter().map(|(name, values)| (name, shown(&values))).collect()
    }
}

/// Some values in a line.
fn shown(values: &[String]) -> String {
    let named = values[..values.len().min(SHOWN)].join(", ");
    match values.len().saturating_sub(SHOWN) {
        0 => named,
        more => format!("{named} and {more} more"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_values_are_cut() {
        let values = |count: usize| (0..count).map(|k| k.to_string()).collect::<Vec<_>>();
        assert_eq!(shown(&values(1)), "0");
        assert_eq!(shown(&values(8)), "0, 1, 2, 3, 4, 5, 6, 7");
        assert_eq!(shown(&values(10)), "0, 1, 2, 3, 4, 5, 6, 7 and 2 more");
    }
}
