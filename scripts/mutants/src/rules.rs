//! What becomes of operators, names of methods, and numbers.

/// Name of the rule, and what stands in place of a binary operator.
pub fn operator(old: &str) -> Option<(&'static str, &'static [&'static str])> {
    let arithmetic: &[&str] = match old {
        "+" => &["-"],
        "-" => &["+"],
        "*" => &["+"],
        "/" => &["*"],
        "%" => &["/"],
        "&" => &["|"],
        "|" => &["&"],
        "^" => &["|"],
        "<<" => &[">>"],
        ">>" => &["<<"],
        "&&" => &["||"],
        "||" => &["&&"],
        "+=" => &["-="],
        "-=" => &["+="],
        "*=" => &["+="],
        "|=" => &["&="],
        "&=" => &["|="],
        _ => &[],
    };
    let comparison: &[&str] = match old {
        "==" => &["!="],
        "!=" => &["=="],
        "<" => &["<=", ">"],
        "<=" => &["<", ">="],
        ">" => &[">=", "<"],
        ">=" => &[">", "<="],
        _ => &[],
    };
    match (arithmetic, comparison) {
        ([], []) => None,
        ([], new) => Some(("condition", new)),
        (new, _) => Some(("operator", new)),
    }
}

/// The method that is called instead.
pub fn method(old: &str) -> Option<&'static str> {
    Some(match old {
        "min" => "max",
        "max" => "min",
        "any" => "all",
        "all" => "any",
        "div_euclid" => "wrapping_div",
        "saturating_sub" => "wrapping_sub",
        "is_some_and" => "is_none_or",
        "is_none_or" => "is_some_and",
        _ => return None,
    })
}

/// What a function of this type gives without doing anything; nothing if there is no telling.
pub fn results(output: &str) -> Vec<&'static str> {
    match output {
        "" => vec![" return;"],
        "bool" => vec![" return true;", " return false;"],
        "u8" | "u32" | "u64" | "u128" | "usize" | "i32" | "i64" | "i128" => vec![" return 0;", " return 1;"],
        _ if output.contains('&') || output.contains("impl ") || output.contains('!') => vec![],
        _ => vec![" return Default::default();"],
    }
}
