//! Enough of Rust's text for tests that look at the source: code without comments, bodies of functions, and calls.

/// `text` without comments and without what stands in strings and characters, each replaced by blanks; line breaks stay.
pub fn code(text: &str) -> String {
    let bytes = text.as_bytes();
    let mut out = bytes.to_vec();
    let mut blank = |from: usize, to: usize| out[from..to].iter_mut().filter(|b| **b != b'\n').for_each(|b| *b = b' ');
    let mut at = 0;
    while at < bytes.len() {
        let rest = &text.as_bytes()[at..];
        let end = match rest {
            [b'/', b'/', ..] => at + rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len()),
            [b'/', b'*', ..] => at + block_comment(rest),
            [b'r', b'"' | b'#', ..] if !is_word_before(bytes, at) && raw_string(rest).is_some() => at + raw_string(rest).unwrap_or(1),
            [b'"', ..] => at + quoted(rest),
            [b'\'', ..] if character(rest).is_some() => at + character(rest).unwrap_or(1),
            _ => {
                at += 1;
                continue;
            }
        };
        blank(at, end);
        at = end;
    }
    String::from_utf8(out).expect("whole characters were replaced")
}

fn is_word(b: u8) -> bool {
    b.is_ascii_alphanumeric() || b == b'_'
}

fn is_word_before(bytes: &[u8], at: usize) -> bool {
    at > 0 && is_word(bytes[at - 1])
}

fn block_comment(rest: &[u8]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        match &rest[at..] {
            [b'/', b'*', ..] => (depth, at) = (depth + 1, at + 2),
            [b'*', b'/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

fn quoted(rest: &[u8]) -> usize {
    let mut at = 1;
    while at < rest.len() && rest[at] != b'"' {
        at += if rest[at] == b'\\' { 2 } else { 1 };
    }
    (at + 1).min(rest.len())
}

fn raw_string(rest: &[u8]) -> Option<usize> {
    let hashes = rest[1..].iter().take_while(|&&b| b == b'#').count();
    let open = 2 + hashes;
    if rest.get(open - 1) != Some(&b'"') {
        return None;
    }
    let close = [b"\"".as_slice(), &b"#".repeat(hashes)].concat();
    let length = rest[open..].windows(close.len()).position(|w| w == close)?;
    Some(open + length + close.len())
}

/// A character's length, quotes included; `None` for a lifetime.
fn character(rest: &[u8]) -> Option<usize> {
    if rest.get(1) == Some(&b'\\') {
        return rest[3..].iter().position(|&b| b == b'\'').map(|at| at + 4);
    }
    let text = std::str::from_utf8(&rest[1..rest.len().min(5)]).or_else(|e| std::str::from_utf8(&rest[1..1 + e.valid_up_to()])).ok()?;
    let length = text.chars().next()?.len_utf8();
    (rest.get(1 + length) == Some(&b'\'')).then_some(length + 2)
}

/// From an opening bracket at `from` to behind its partner.
fn bracketed(code: &str, from: usize) -> &str {
    let mut depth = 0;
    for (at, b) in code.bytes().enumerate().skip(from) {
        match b {
            b'{' | b'(' | b'[' => depth += 1,
            b'}' | b')' | b']' => depth -= 1,
            _ => continue,
        }
        if depth == 0 {
            return &code[from..=at];
        }
    }
    &code[from..]
}

/// The length of a list of generic parameters; 0 where there is none.
fn generics(code: &str) -> usize {
    let mut depth = 0;
    for (at, b) in code.bytes().enumerate() {
        match b {
            b'<' => depth += 1,
            b'>' if code.as_bytes()[at - 1] != b'-' => depth -= 1,
            _ => (),
        }
        if depth == 0 {
            return if at == 0 { 0 } else { at + 1 };
        }
    }
    code.len()
}

/// The body of function `name` in what [`code`] gave, its braces included.
pub fn body<'a>(code: &'a str, name: &str) -> Option<&'a str> {
    let head = format!("fn {name}");
    let behind = code.match_indices(&head).map(|(at, _)| at + head.len()).find(|&at| code[at..].starts_with(['(', '<']))?;
    let arguments = behind + generics(&code[behind..]);
    let after = arguments + bracketed(code, arguments).len();
    // Behind the type that it gives, in which brackets may stand.
    let mut open = after;
    loop {
        open += code[open..].find(['{', ';', '(', '['])?;
        match code.as_bytes()[open] {
            b'(' | b'[' => open += bracketed(code, open).len(),
            _ => break,
        }
    }
    code[open..].starts_with('{').then(|| bracketed(code, open))
}

/// `code` without its modules of tests.
pub fn without_tests(code: &str) -> String {
    let mut left = code.to_owned();
    while let Some(at) = left.find("#[cfg(test)]") {
        let end = match left[at..].find(['{', ';']) {
            Some(open) if left[at + open..].starts_with('{') => at + open + bracketed(&left, at + open).len(),
            Some(semicolon) => at + semicolon + 1,
            None => left.len(),
        };
        left.replace_range(at..end, "");
    }
    left
}

/// Names of functions and macros that are called in `code`: a macro's with its exclamation mark.
pub fn calls(code: &str) -> impl Iterator<Item = &str> {
    code.match_indices(['(', '!']).filter_map(|(at, found)| {
        let before = code[..at].bytes().rev().take_while(|&b| is_word(b)).count();
        let name = &code[at - before..at];
        let is_macro = found == "!" && code[at + 1..].starts_with(['(', '[', '{']);
        let end = if is_macro { at + 1 } else { at };
        (!name.is_empty() && (found == "(" || is_macro)).then(|| &code[at - before..end])
    })
}
