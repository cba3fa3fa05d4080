//! A file with mutants in it, each behind a question to `crate::mutant::is`.

use crate::site::Site;
use std::ops::Range;

/// A mutant's text stands between comments with its number, so that an error of the compiler can be told to be its.
fn marked(mutant: u32, text: &str) -> String {
    format!("/*<{mutant}*/{text}/*>{mutant}*/")
}

/// All mutants of one place.
struct Place {
    range: Range<usize>,
    mutants: Vec<(u32, Site)>,
}

struct Rewriter<'a> {
    text: &'a str,
    /// Outer places before inner ones, otherwise as they stand.
    places: Vec<Place>,
}

impl Rewriter<'_> {
    /// The text of `range` with the places in it written anew; `from` is the number of the first that may be.
    fn within(&self, range: Range<usize>, from: usize) -> String {
        let (mut out, mut at) = (String::new(), range.start);
        for (number, place) in self.places.iter().enumerate().skip(from) {
            if place.range.start >= at && place.range.end <= range.end {
                out += &self.text[at..place.range.start];
                out += &self.place(number);
                at = place.range.end;
            }
        }
        out + &self.text[at..range.end]
    }

    /// A place, as each of its mutants has it and as it was.
    fn place(&self, number: usize) -> String {
        let Place { range, mutants } = &self.places[number];
        let mut out = String::new();
        for (mutant, site) in mutants {
            let before = self.within(range.start..site.at.start.max(range.start), number + 1);
            let after = self.within(site.at.end.min(range.end)..range.end, number + 1);
            let text = marked(*mutant, &format!("{before}{}{after}", site.by));
            out += &match site.inserts() {
                true => format!(" if crate::mutant::is({mutant}) {{ {text} }}"),
                false => format!("if crate::mutant::is({mutant}) {{ {text} }} else "),
            };
        }
        if range.is_empty() { out } else { format!("({out}{{ {} }})", self.within(range.clone(), number + 1)) }
    }
}

/// `text` with these mutants, each with its number.
pub fn rewritten(text: &str, mutants: &[(u32, Site)]) -> String {
    let mut places: Vec<Place> = Vec::new();
    for (mutant, site) in mutants {
        match places.iter_mut().find(|place| place.range == site.place) {
            Some(place) => place.mutants.push((*mutant, site.clone())),
            None => places.push(Place { range: site.place.clone(), mutants: vec![(*mutant, site.clone())] }),
        }
    }
    places.sort_by_key(|place| (place.range.start, usize::MAX - place.range.end));
    Rewriter { text, places }.within(0..text.len(), 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::find::sites;

    const TEXT: &str = "fn least(a: u32, b: u32) -> bool {\n    if a < b + 1 { return !(a == 7); }\n    a.min(b) & 2 == 0\n}\n";

    fn with(choose: impl Fn(&Site) -> bool) -> String {
        let all = sites(TEXT).unwrap().into_iter().filter(choose);
        rewritten(TEXT, &(1..).zip(all).collect::<Vec<_>>())
    }

    #[test]
    fn one_mutant_stands_beside_what_was_there() {
        assert_eq!(rewritten(TEXT, &[]), TEXT);
        let text = with(|site| &TEXT[site.at.clone()] == "+");
        assert!(text.contains("if a < (if crate::mutant::is(1) { /*<1*/b - 1/*>1*/ } else { b + 1 }) {"), "{text}");
        let text = with(|site| site.by == " return true;");
        assert!(text.starts_with("fn least(a: u32, b: u32) -> bool { if crate::mutant::is(1) { /*<1*/ return true;/*>1*/ }\n"), "{text}");
    }

    #[test]
    fn mutants_of_one_place_are_one_choice() {
        let text = with(|site| site.by == "<=" || site.by == ">" || site.by == "true");
        let by = "if crate::mutant::is(1) { /*<1*/true/*>1*/ } else if crate::mutant::is(2) { /*<2*/a <= b + 1/*>2*/ } else if crate::mutant::is(3) \
                  { /*<3*/a > b + 1/*>3*/ } else { a < b + 1 }";
        assert!(text.contains(by), "{text}");
    }

    #[test]
    fn all_mutants_at_once_are_a_program() {
        let count = sites(TEXT).unwrap().len();
        let text = with(|_| true);
        syn::parse_file(&text).unwrap();
        assert!((1..=count).all(|mutant| text.contains(&format!("crate::mutant::is({mutant})"))), "{text}");
    }
}
