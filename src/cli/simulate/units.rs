//! Units in which figures of any size are read easily: 1 to 1000 of them.

/// A unit of an axis.
pub struct Unit {
    /// How much of what values are in makes one.
    pub size: f64,
    pub name: String,
}

const PREFIXES: [(&str, f64); 8] = [("p", 1e-12), ("n", 1e-9), ("µ", 1e-6), ("m", 1e-3), ("", 1.0), ("k", 1e3), ("M", 1e6), ("G", 1e9)];
const NUMBERS: [(&str, f64); 4] = [("", 1.0), ("thousand ", 1e3), ("million ", 1e6), ("billion ", 1e9)];

impl Unit {
    /// The unit for values up to `largest` of the plain unit.
    pub fn of(largest: f64, plain: &str) -> Self {
        // Nobody counts in kiloseconds.
        let end = if ["s", "J"].contains(&plain) { 5 } else { PREFIXES.len() };
        Self::among(&PREFIXES[..end], largest, plain)
    }

    fn among(prefixes: &[(&str, f64)], largest: f64, plain: &str) -> Self {
        let plain_size = ("", 1.0);
        // Of nothing the plain unit; of less than the smallest that.
        let fitting = prefixes.iter().rev().find(|(_, size)| largest >= *size).or(prefixes.first().filter(|_| largest > 0.0));
        let (prefix, size) = *fitting.unwrap_or(&plain_size);
        Self { size, name: format!("{prefix}{plain}") }
    }
}

/// For times up to `largest` milliseconds, of which values are.
pub fn time_unit(largest: f64) -> Unit {
    let unit = Unit::of(largest * 1e-3, "s");
    Unit { size: unit.size * 1e3, ..unit }
}

/// For energies up to `largest` of a result's unit, of which values are: `uJ`, or accesses where they are relative.
pub fn energy_unit(unit: &str, largest: f64) -> Unit {
    if unit == "uJ" {
        let joules = Unit::of(largest * 1e-6, "J");
        Unit { size: joules.size * 1e6, ..joules }
    } else {
        Unit::among(&NUMBERS, largest, unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_size_has_its_unit() {
        let of = |unit: Unit, value: f64| format!("{:.3} {}", value / unit.size, unit.name);
        for (ms, wanted) in
            [(0.0, "0.000 s"), (2.5e-7, "250.000 ps"), (0.0012, "1.200 µs"), (0.5, "500.000 µs"), (12.0, "12.000 ms"), (5e6, "5000.000 s")]
        {
            assert_eq!(of(time_unit(ms), ms), wanted);
        }
        for (value, wanted) in [(0.0004, "400.000 pJ"), (0.3, "300.000 nJ"), (70.0, "70.000 µJ"), (9e3, "9.000 mJ")] {
            assert_eq!(of(energy_unit("uJ", value), value), wanted);
        }
        for (value, wanted) in [(12.0, "12.000 L1 accesses"), (2.5e6, "2.500 million L1 accesses")] {
            assert_eq!(of(energy_unit("L1 accesses", value), value), wanted);
        }
        assert_eq!(of(Unit::of(3.2e10, "B/s"), 3.2e10), "32.000 GB/s");
    }
}
