//! The terminal: whether there are colours, how wide it is, and tables that fit it.

use clap::ColorChoice;
use std::ffi::OsString;

/// Blanks between columns of a table that is too wide, and of one that is still too wide then.
const GAPS: [usize; 2] = [2, 1];
/// Blanks before the second and further lines of a paragraph.
const INDENT: usize = 4;

/// What `--color` says, before the command line is read: it holds for complaints about the command line, too. A wrong value is refused later.
pub fn color(words: impl IntoIterator<Item = OsString>) -> ColorChoice {
    let mut words = words.into_iter().map(|word| word.to_string_lossy().into_owned()).take_while(|word| word != "--");
    let mut choice = ColorChoice::Auto;
    while let Some(word) = words.next() {
        let value = if word == "--color" { words.next() } else { word.strip_prefix("--color=").map(str::to_owned) };
        choice = value.and_then(|value| value.parse().ok()).unwrap_or(choice);
    }
    choice
}

/// Makes the choice for all that is printed.
pub fn set_color(choice: ColorChoice) {
    match choice {
        ColorChoice::Auto => anstream::ColorChoice::Auto,
        ColorChoice::Always => anstream::ColorChoice::Always,
        ColorChoice::Never => anstream::ColorChoice::Never,
    }
    .write_global();
}

/// Says a line on standard error that begins with `label`, such as `error:`, in the colours of clap's own errors.
pub fn complain(label: &str, text: &str) {
    use std::io::Write;
    let styles = clap::builder::Styles::styled();
    let style = if label == "error:" { styles.get_error() } else { styles.get_literal() };
    // If nobody reads standard error there is nobody to tell; `eprintln` would panic.
    let _ = writeln!(anstream::stderr(), "{style}{label}{style:#} {text}");
}

/// Columns of the terminal that standard output goes to; else what the environment's `COLUMNS` says; none for a file or a pipe.
pub fn columns() -> Option<usize> {
    let of_terminal = terminal_size::terminal_size_of(std::io::stdout()).map(|(width, _)| usize::from(width.0));
    of_terminal.or_else(|| std::env::var("COLUMNS").ok()?.parse().ok()).filter(|&columns| columns >= 20)
}

/// `text` with no line longer than `columns`, as far as words allow: tables are squeezed, then broken between columns; paragraphs are wrapped.
pub fn fit(text: &str, columns: usize) -> String {
    text.split("\n\n").map(|block| fit_block(block, columns)).collect::<Vec<_>>().join("\n\n")
}

fn fits(lines: &[&str], columns: usize) -> bool {
    lines.iter().all(|line| line.chars().count() <= columns)
}

/// Whether a line has columns. A paragraph, or the name of a part, has no gaps, and says nothing of where columns are.
fn is_row(line: &str) -> bool {
    line.trim().contains("  ")
}

/// Of a block without empty lines. Where rows are indented, a row that is not begins a table of its own.
fn fit_block(block: &str, columns: usize) -> String {
    let lines: Vec<&str> = block.split('\n').collect();
    if fits(&lines, columns) {
        return block.to_owned();
    }
    let has_indented = lines.iter().any(|line| line.starts_with(' '));
    let tables = lines.chunk_by(|_, next| !has_indented || next.starts_with(' ') || !is_row(next));
    tables.map(|table| fit_table(table, columns)).collect::<Vec<_>>().join("\n")
}

fn fit_table(lines: &[&str], columns: usize) -> String {
    if fits(lines, columns) {
        return lines.join("\n");
    }
    let rows: Vec<Vec<char>> = lines.iter().filter(|line| is_row(line)).map(|line| line.chars().collect()).collect();
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    let blank: Vec<bool> = (0..width).map(|at| rows.iter().all(|row| row.get(at).is_none_or(|&c| c == ' '))).collect();
    let indent = blank.iter().take_while(|&&is| is).count();
    let squeezed = GAPS.map(|gap| {
        let is_kept = |&at: &usize| at < indent.max(gap) || !blank[at - gap..=at].iter().all(|&is| is);
        (0..width).filter(is_kept).collect::<Vec<_>>()
    });
    let [wide, narrow] = squeezed;
    let kept = if width <= columns {
        (0..width).collect()
    } else if wide.len() <= columns {
        wide
    } else {
        narrow
    };
    let parts = parts(&kept, &blank, columns);
    let row = |line: &str, part: &[usize]| {
        let cells: Vec<char> = line.chars().collect();
        let row: String = part.iter().map(|&at| cells.get(at).copied().unwrap_or(' ')).collect();
        row.trim_end().to_owned()
    };
    let mut out = Vec::new();
    for (number, part) in parts.iter().enumerate() {
        for line in lines {
            if is_row(line) {
                out.push(row(line, part));
            } else if number == 0 {
                out.push(wrap(line, columns));
            }
        }
    }
    out.join("\n")
}

/// Splits a table into parts that fit the width: each part has whole columns and repeats the first one.
fn parts(kept: &[usize], blank: &[bool], columns: usize) -> Vec<Vec<usize>> {
    let indent = kept.iter().take_while(|&&at| blank[at]).count();
    // Columns are two blanks apart, words of a cell one: that is for cells that are too wide.
    let cells = |apart: usize| -> Vec<&[usize]> {
        let ends =
            |at: usize, next: usize| !blank[next] && (at + 1).checked_sub(apart).is_some_and(|from| blank[from..=at].iter().all(|&is| is));
        kept[indent..].chunk_by(|&at, &next| !ends(at, next)).collect()
    };
    let columns_apart = cells(2);
    let widest = columns_apart.iter().skip(1).map(|cell| cell.len()).max().unwrap_or(0);
    let cells = if indent + columns_apart.first().map_or(0, |name| name.len()) + widest <= columns { columns_apart } else { cells(1) };
    let Some((name, cells)) = cells.split_first() else { return vec![kept.to_vec()] };
    let name = &kept[..indent + name.len()];
    let mut parts: Vec<Vec<usize>> = vec![name.to_vec()];
    for cell in cells {
        match parts.last_mut() {
            Some(part) if part.len() + cell.len() <= columns || part.len() == name.len() => part.extend_from_slice(cell),
            _ => parts.push([name, cell].concat()),
        }
    }
    parts
}

/// A paragraph in several lines.
fn wrap(line: &str, columns: usize) -> String {
    let mut text = String::new();
    let mut length = 0;
    for word in line.split_inclusive(' ') {
        let of = word.trim_end().chars().count();
        if length > INDENT && length + of > columns {
            text.truncate(text.trim_end().len());
            text += &format!("\n{:INDENT$}", "");
            length = INDENT;
        }
        text += word;
        length += word.chars().count();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn widest(text: &str) -> usize {
        text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
    }

    #[test]
    fn what_fits_stays_as_it_is() {
        let text = "a      b\nc      d\n\nand a paragraph";
        assert_eq!(fit(text, 20), text);
    }

    #[test]
    fn columns_move_together_then_a_table_is_broken() {
        let text = "name          first        second\n  ab          1,234             5";
        assert_eq!(fit(text, 30), "name  first  second\n  ab  1,234       5");
        assert_eq!(fit(text, 18), "name first second\n  ab 1,234      5");
        let broken = fit(text, 12);
        assert_eq!(broken, "name first\n  ab 1,234\nname second\n  ab      5");
    }

    #[test]
    fn parts_of_a_table_share_its_columns_and_repeat_its_names() {
        let text = "              needed   of   saves\nlevels\n  of a tree        3   10   many bits\n  stored           3   10   few";
        let shown = fit(text, 22);
        assert_eq!(
            shown,
            "            needed of\nlevels\n  of a tree      3 10\n  stored         3 10\n            saves\n  of a tree many bits\n  stored    few"
        );
    }

    #[test]
    fn tables_of_one_block_are_squeezed_by_themselves_and_paragraphs_wrapped() {
        let text = "caches      requests            hits\n  L1           12345               1\nwaits          queue\n  L1               7\na paragraph of several words that is long";
        let shown = fit(text, 24);
        assert!(widest(&shown) <= 24 && shown.contains("\nwaits          queue\n"), "{shown}");
        assert!(shown.starts_with("caches  requests  hits\n  L1       12345     1\n"), "{shown}");
        assert!(shown.ends_with("a paragraph of several\n    words that is long"), "{shown}");
        // Nothing is lost.
        let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(words(&shown), words(text));
    }

    #[test]
    fn color_is_known_before_the_command_line_is_read() {
        let of = |line: &str| color(line.split(' ').map(OsString::from));
        for (line, choice) in [
            ("info a.lod", ColorChoice::Auto),
            ("--color never info a.lod", ColorChoice::Never),
            ("info a.lod --color=always", ColorChoice::Always),
            ("info --color purple", ColorChoice::Auto),
            ("info -- --color=always", ColorChoice::Auto),
        ] {
            assert_eq!(of(line), choice, "{line}");
        }
    }
}
