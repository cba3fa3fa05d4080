//! The sites of a file: expressions of functions that run, outside of tests, constants, types, patterns and macros, and of what accounts for area and cycles.

use crate::rules;
use crate::site::Site;
use anyhow::Result;
use std::ops::Range;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, BinOp, Block, Expr, ImplItem, Item, Lit, Pat, ReturnType, Signature, Type, UnOp};

/// Functions of blocks that say what they take and how long, not what they compute.
const ACCOUNTS: [&str; 4] = ["parts", "timing", "arithmetic", "edge_arithmetic"];
/// Types of such accounts.
const ACCOUNT_TYPES: [&str; 3] = ["Parts", "Registers", "Timing"];

/// All sites of a file, in its order.
pub fn sites(text: &str) -> Result<Vec<Site>> {
    let file = syn::parse_file(text)?;
    let mut finder = Finder { text, sites: Vec::new() };
    finder.visit_file(&file);
    Ok(finder.sites)
}

struct Finder<'a> {
    text: &'a str,
    sites: Vec<Site>,
}

fn range(of: &impl Spanned) -> Range<usize> {
    of.span().byte_range()
}

fn of_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| attribute.path().is_ident("cfg") || attribute.path().is_ident("test"))
}

impl Finder<'_> {
    fn add(&mut self, rule: &'static str, place: Range<usize>, at: Range<usize>, by: impl Into<String>) {
        self.sites.push(Site { rule, place, at, by: by.into() });
    }

    fn function(&mut self, signature: &Signature, attributes: &[Attribute], block: &Block) {
        let output = match &signature.output {
            ReturnType::Default => "",
            ReturnType::Type(_, output) => &self.text[range(output)],
        };
        let accounts = ACCOUNTS.iter().any(|name| signature.ident == name) || ACCOUNT_TYPES.iter().any(|name| output.contains(name));
        if signature.constness.is_some() || accounts || of_tests(attributes) {
            return;
        }
        let start = range(&block.brace_token.span.open()).end;
        for by in rules::results(output) {
            self.add("body", start..start, start..start, by);
        }
        self.visit_block(block);
    }

    fn condition(&mut self, condition: &Expr, by: &[&str]) {
        let mut lets = Lets(false);
        lets.visit_expr(condition);
        if !lets.0 {
            let place = range(condition);
            by.iter().for_each(|&by| self.add("branch", place.clone(), place.clone(), by));
        }
    }

    fn literal(&mut self, literal: &Lit) {
        let place = range(literal);
        match literal {
            Lit::Int(number) => {
                let Ok(value) = number.base10_parse::<u128>() else { return };
                let near = [value.checked_add(1), value.checked_sub(1)];
                for near in near.into_iter().flatten() {
                    self.add("constant", place.clone(), place.clone(), format!("{near}{}", number.suffix()));
                }
            }
            Lit::Float(number) => {
                let Ok(value) = number.base10_parse::<f64>() else { return };
                self.add("constant", place.clone(), place, format!("{:?}{}", value + 1.0, number.suffix()));
            }
            Lit::Bool(flag) => self.add("constant", place.clone(), place, (!flag.value).to_string()),
            _ => {}
        }
    }

    fn own(&mut self, expression: &Expr) {
        let place = range(expression);
        match expression {
            Expr::Binary(binary) => self.operator(place, &binary.op),
            Expr::Unary(unary) => match unary.op {
                UnOp::Not(_) => self.add("condition", place, range(&unary.op), ""),
                UnOp::Neg(_) => self.add("minus", place, range(&unary.op), ""),
                _ => {}
            },
            Expr::MethodCall(call) => {
                if let Some(new) = rules::method(&call.method.to_string()) {
                    self.add("method", place, range(&call.method), new);
                }
            }
            Expr::Path(path) if path.path.segments.len() > 1 => {
                let last = path.path.segments.last().map(|segment| &segment.ident);
                if let Some((last, new)) = last.and_then(|last| Some((last, rules::method(&last.to_string())?))) {
                    self.add("method", place, range(last), new);
                }
            }
            Expr::If(branch) => self.condition(&branch.cond, &["true", "false"]),
            Expr::While(repeat) => self.condition(&repeat.cond, &["false"]),
            Expr::Lit(literal) => self.literal(&literal.lit),
            _ => {}
        }
    }

    fn operator(&mut self, place: Range<usize>, operator: &BinOp) {
        let at = range(operator);
        if let Some((rule, new)) = rules::operator(&self.text[at.clone()]) {
            new.iter().for_each(|&new| self.add(rule, place.clone(), at.clone(), new));
        }
    }
}

/// A condition binds names.
struct Lets(bool);

impl<'a> Visit<'a> for Lets {
    fn visit_expr_let(&mut self, _: &'a syn::ExprLet) {
        self.0 = true;
    }
}

impl<'a> Visit<'a> for Finder<'_> {
    fn visit_item(&mut self, item: &'a Item) {
        match item {
            Item::Fn(function) => self.function(&function.sig, &function.attrs, &function.block),
            Item::Mod(module) if !of_tests(&module.attrs) => visit::visit_item_mod(self, module),
            Item::Impl(block) => block.items.iter().for_each(|item| self.visit_impl_item(item)),
            Item::Static(item) => Closures(self).visit_expr(&item.expr),
            _ => {}
        }
    }

    fn visit_impl_item(&mut self, item: &'a ImplItem) {
        if let ImplItem::Fn(function) = item {
            self.function(&function.sig, &function.attrs, &function.block);
        }
    }

    fn visit_expr(&mut self, expression: &'a Expr) {
        match expression {
            // Compiled, not run.
            Expr::Const(_) => {}
            Expr::Repeat(repeat) => self.visit_expr(&repeat.expr),
            _ => {
                self.own(expression);
                visit::visit_expr(self, expression);
            }
        }
    }

    fn visit_pat(&mut self, _: &'a Pat) {}

    fn visit_type(&mut self, _: &'a Type) {}

    fn visit_attribute(&mut self, _: &'a Attribute) {}

    fn visit_angle_bracketed_generic_arguments(&mut self, _: &'a syn::AngleBracketedGenericArguments) {}
}

/// What runs of a static's value.
struct Closures<'f, 'a>(&'f mut Finder<'a>);

impl<'a> Visit<'a> for Closures<'_, '_> {
    fn visit_expr_closure(&mut self, closure: &'a syn::ExprClosure) {
        self.0.visit_expr(&closure.body);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each site as what is replaced and by what.
    fn found(text: &str) -> Vec<(String, String)> {
        sites(text).unwrap().into_iter().map(|site| (text[site.at].to_owned(), site.by)).collect()
    }

    fn inner(expression: &str) -> Vec<(String, String)> {
        let mut all = found(&format!("fn f() -> impl Sized {{ {expression} }}"));
        all.sort();
        all
    }

    fn pairs(wanted: &[(&str, &str)]) -> Vec<(String, String)> {
        wanted.iter().map(|&(old, new)| (old.to_owned(), new.to_owned())).collect()
    }

    #[test]
    fn every_rule_finds_its_sites() {
        assert_eq!(inner("a + b"), pairs(&[("+", "-")]));
        assert_eq!(inner("a <= -b"), pairs(&[("-", ""), ("<=", "<"), ("<=", ">=")]));
        assert_eq!(inner("!a || b"), pairs(&[("!", ""), ("||", "&&")]));
        assert_eq!(inner("a.min(i64::max(b, c))"), pairs(&[("max", "min"), ("min", "max")]));
        assert_eq!(inner("7u32"), pairs(&[("7u32", "6u32"), ("7u32", "8u32")]));
        assert_eq!(inner("0"), pairs(&[("0", "1")]));
        assert_eq!(inner("(1.5, true)"), pairs(&[("1.5", "2.5"), ("true", "false")]));
        assert_eq!(inner("if a { b } else { c }"), pairs(&[("a", "false"), ("a", "true")]));
        assert_eq!(inner("while a { b += c; }"), pairs(&[("+=", "-="), ("a", "false")]));
        assert_eq!(found("fn f() -> bool { a() }"), pairs(&[("", " return true;"), ("", " return false;")]));
        assert_eq!(found("static S: L = L::new(|| a + b);"), pairs(&[("+", "-")]));
    }

    #[test]
    fn what_does_not_run_or_only_accounts_has_none() {
        for text in [
            "const A: u32 = 1 + 2;",
            "const fn f() -> u32 { 1 + 2 }",
            "#[cfg(test)] mod tests { fn f() -> u32 { 1 + 2 } }",
            "impl B { fn parts(f: &F) -> u32 { 1 + 2 } }",
            "fn f() -> Registers { g(1 + 2) }",
            "trait T { fn f() -> u32 { 1 + 2 } }",
            "enum E { A = 1 }",
        ] {
            assert_eq!(found(text), [], "{text}");
        }
        for text in [
            "debug_assert!(a < 1)",
            "match a { 1 => b, _ => c }",
            "if let 1 = a { b }",
            "[a; 2]",
            "f::<{ 1 + 2 }>()",
            "{ const A: u32 = 1; A }",
        ] {
            assert_eq!(inner(text), [], "{text}");
        }
    }

    #[test]
    fn lines_are_shown_before_and_after() {
        let text = "fn f() -> impl Sized {\n    let é = 1;\n    g(a * b)\n}\n";
        let site = sites(text).unwrap().into_iter().find(|site| site.by == "+").unwrap();
        assert_eq!((site.line(text), site.lines(text)), (3, ("g(a * b)".into(), "g(a + b)".into())));
    }
}
