//! Tables of a document: all points as CSV, and what methods cost at equal error as LaTeX.

use super::canvas::short;
use crate::report::error_time::{COSTS, ERRORS, EqualCost, EqualError, ErrorTime, Point};
use std::collections::BTreeMap;

/// All points, a line for each machine that they have costs of.
pub fn csv(document: &ErrorTime) -> String {
    let mut text = head(&["scene", "distance", "method", "setting", "samples"]);
    for point in &document.points {
        lines(&mut text, document, point, &[point.method.clone(), point.setting.clone(), point.samples.to_string()]);
    }
    text
}

/// What was left out, likewise.
pub fn left_out_csv(document: &ErrorTime) -> String {
    let mut text = head(&["scene", "distance", "setting", "left_out", "coordinate_zeros", "direction_zeros"]);
    for left in &document.left_out {
        let own = [left.point.setting.clone(), left.what.clone(), left.coordinate_zeros.to_string(), left.direction_zeros.to_string()];
        lines(&mut text, document, &left.point, &own);
    }
    text
}

/// Names of columns: these, the machine, and everything that is measured.
fn head(own: &[&str]) -> String {
    let head = own.iter().chain(&["machine", "compute", "energy_unit"]).map(|&name| name.to_owned());
    let measures = ERRORS.iter().map(|error| error.id).chain(COSTS.iter().map(|cost| cost.id)).map(|id| id.replace('-', "_"));
    head.chain(measures).collect::<Vec<_>>().join(",") + "\n"
}

/// The lines of a point: scene and distance, its `own` cells, the machine, and everything that was measured.
fn lines(text: &mut String, document: &ErrorTime, point: &Point, own: &[String]) {
    let view = &document.views[point.view];
    for costs in &point.costs {
        let mut cells = vec![document.scenes[view.scene].name.clone(), view.distance.to_string()];
        cells.extend_from_slice(own);
        cells.extend([document.machines[costs.machine].title(), costs.compute.clone(), costs.energy.unit.clone()]);
        cells.extend(ERRORS.iter().map(|error| (error.of)(point).map_or_else(String::new, |v| v.to_string())));
        cells.extend(COSTS.iter().map(|cost| (cost.of)(point, costs).map_or_else(String::new, |v| v.to_string())));
        *text += &(cells.iter().map(|cell| quoted(cell)).collect::<Vec<_>>().join(",") + "\n");
    }
}

/// A cell of a CSV file.
fn quoted(cell: &str) -> String {
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.to_owned() }
}

/// What tells a table from the others: scene, samples, error, cost, machine, compute.
type Key = (usize, u32, String, String, usize, String);

/// Costs at equal error, a table (booktabs) for each scene, error, cost and machine: a row for each distance and level.
pub fn latex(document: &ErrorTime) -> String {
    let mut tables: BTreeMap<Key, Vec<&EqualError>> = BTreeMap::new();
    for equal in &document.equal_error {
        let scene = document.views[equal.view].scene;
        let key = (scene, equal.samples, equal.error.clone(), equal.cost.clone(), equal.machine, equal.compute.clone());
        tables.entry(key).or_default().push(equal);
    }
    let mut text = "% \\usepackage{booktabs}\n".to_owned();
    for ((scene, samples, error, cost, machine, compute), mut rows) in tables {
        rows.sort_by(|a, b| document.views[a.view].distance.total_cmp(&document.views[b.view].distance).then(a.level.total_cmp(&b.level)));
        let mut methods: Vec<&str> = Vec::new();
        for method in rows.iter().flat_map(|row| &row.methods) {
            if !methods.contains(&method.method.as_str()) {
                methods.push(&method.method);
            }
        }
        let words = |text: &str| escaped(&text.replace('_', " "));
        let caption = format!(
            "{}, {}: {} where the {} is the same; samples per pixel: {samples}; {}, compute {}. In brackets the cost over ours; with an asterisk the error is larger.",
            escaped(&document.scenes[scene].name),
            document.sizes_in_words(Some(scene)),
            words(&cost),
            words(&error),
            escaped(&document.machines[machine].title()),
            escaped(&compute)
        );
        // Those that chose a setting by themselves stand behind the others.
        let mut rules: Vec<&str> = Vec::new();
        for rule in rows.iter().flat_map(|row| &row.own_rule) {
            if !rules.contains(&rule.method.as_str()) {
                rules.push(&rule.method);
            }
        }
        let head: String = methods.iter().map(|method| format!(" & {}", escaped(method))).collect();
        let head = head + &rules.iter().map(|method| format!(" & {} by its own rule", escaped(method))).collect::<String>();
        text += &format!(
            "\\begin{{table}}\n\\centering\n\\caption{{{caption}}}\n\\begin{{tabular}}{{rrr{}}}\n\\toprule\n",
            "r".repeat(methods.len() + rules.len())
        );
        text += &format!("distance & level & ours{head} \\\\\n\\midrule\n");
        for row in rows {
            let cell = |of: Option<&EqualCost>, is_rule: bool| match of.and_then(|method| Some((method, method.cost?))) {
                Some((EqualCost { ratio, why, .. }, cost)) => {
                    let ratio = ratio.map_or_else(String::new, |ratio| format!(" ({})", short(ratio)));
                    let further = if is_rule && why.is_some() { "$^*$" } else { "" };
                    format!(" & {}{ratio}{further}", short(cost))
                }
                None => format!(" & {}", of.and_then(|method| method.why.as_deref()).map_or_else(|| "--".to_owned(), escaped)),
            };
            let others = methods.iter().map(|name| cell(row.methods.iter().find(|method| method.method == *name), false));
            let others = others.chain(rules.iter().map(|name| cell(row.own_rule.iter().find(|method| method.method == *name), true)));
            let ours = row.ours.map_or_else(|| "--".to_owned(), short);
            text += &format!(
                "{} & {} & {ours}{} \\\\\n",
                short(document.views[row.view].distance),
                short(row.level),
                others.collect::<String>()
            );
        }
        text += "\\bottomrule\n\\end{tabular}\n\\end{table}\n\n";
    }
    text
}

/// Text in LaTeX.
fn escaped(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', c]),
            '~' => out += "\\textasciitilde{}",
            '^' => out += "\\textasciicircum{}",
            '\\' => out += "\\textbackslash{}",
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_safe_in_its_format() {
        assert_eq!(escaped("a_b & 5% \\x"), "a\\_b \\& 5\\% \\textbackslash{}x");
        assert_eq!([quoted("a"), quoted("a,\"b\"")], ["a", "\"a,\"\"b\"\"\""]);
    }
}
