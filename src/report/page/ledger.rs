//! Tables of a Markdown document: the ledger of claims.

use serde::Serialize;

/// A table, under the heading above it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Ledger {
    /// The heading.
    pub title: String,
    /// Names of the columns.
    pub head: Vec<String>,
    /// Cells.
    pub rows: Vec<Vec<String>>,
}

/// The tables of a Markdown document; code keeps its backticks.
pub fn ledger(text: &str) -> Vec<Ledger> {
    let (mut tables, mut title): (Vec<Ledger>, String) = (Vec::new(), String::new());
    let lines: Vec<_> = text.lines().map(str::trim).collect();
    let mut inside = false;
    for (k, line) in lines.iter().enumerate() {
        if let Some(heading) = line.strip_prefix('#') {
            title = heading.trim_start_matches('#').trim().to_owned();
        }
        match (is_row(line), inside) {
            (true, true) if !is_rule(line) => {
                if let Some(table) = tables.last_mut() {
                    let mut row = cells(line);
                    row.resize(table.head.len(), String::new());
                    table.rows.push(row);
                }
            }
            (true, false) if lines.get(k + 1).is_some_and(|next| is_rule(next)) => {
                tables.push(Ledger { title: title.clone(), head: cells(line), rows: Vec::new() });
                inside = true;
            }
            (true, _) => {}
            (false, _) => inside = false,
        }
    }
    tables
}

fn is_row(line: &str) -> bool {
    line.len() > 1 && line.starts_with('|') && line.ends_with('|')
}

fn is_rule(line: &str) -> bool {
    is_row(line) && line.contains('-') && line.chars().all(|c| "|-: ".contains(c))
}

/// Cells of a row; a bar behind a backslash is text.
fn cells(line: &str) -> Vec<String> {
    let inner = line.trim_start_matches('|');
    let inner = inner.strip_suffix('|').unwrap_or(inner).replace("\\|", "\u{0}");
    inner.split('|').map(|cell| cell.trim().replace('\u{0}', "|")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_stand_under_their_headings() {
        let text = "# A\nwords\n## Ledger\n| a | b |\n|---|---:|\n| `x` | 1 \\| 2 |\n| y |\n\n| no | table |\n\n| c |\n|---|\n";
        let tables = ledger(text);
        assert_eq!(tables.len(), 2);
        assert_eq!((tables[0].title.as_str(), &tables[0].head), ("Ledger", &vec!["a".to_owned(), "b".to_owned()]));
        assert_eq!(tables[0].rows, [["`x`", "1 | 2"], ["y", ""]]);
        assert!(tables[1].rows.is_empty());
        assert!(ledger("").is_empty() && ledger("|\n|-|").is_empty());
    }
}
