//! What one module says, read with `syn`: the names that it binds and the paths that its code uses. Tests are left out.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeMap;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, Meta, UseTree, Visibility};

/// The names of a path, first to last.
pub(super) type Names = Vec<String>;

/// What a name of a module means.
pub(super) enum Binding {
    /// Defined here.
    Item,
    /// A module below this one, with its own file.
    Child,
    /// Brought here by `use`.
    Import(Names),
}

/// A line of `use`.
pub(super) struct Import {
    pub path: Names,
    /// Others may use it from here.
    pub is_shown: bool,
}

/// A module that was read.
#[derive(Default)]
pub(super) struct Text {
    pub scope: BTreeMap<String, Vec<Binding>>,
    pub imports: Vec<Import>,
    /// Modules and enums all of whose names are brought here.
    pub globs: Vec<Names>,
    /// Paths in code, `use` apart.
    pub paths: Vec<Names>,
    /// Names of variables and of generic parameters of what is being read.
    locals: Vec<Vec<String>>,
}

/// Reads `text` of the module `name` and the modules within it, with their whole names.
pub(super) fn read(name: &str, text: &str) -> Vec<(String, Text)> {
    let file = syn::parse_file(text).unwrap_or_else(|error| panic!("{name}: {error}"));
    let mut all = Vec::new();
    within(name, &file.items, &mut all);
    all
}

fn within(name: &str, items: &[Item], all: &mut Vec<(String, Text)>) {
    let mut text = Text::default();
    for item in items.iter().filter(|item| !is_test(attributes(item))) {
        text.bind_item(item);
        match item {
            Item::Mod(module) => {
                if let Some((_, items)) = &module.content {
                    within(&joined(name, &module.ident.to_string()), items, all);
                }
            }
            item => text.visit_item(item),
        }
    }
    all.push((name.to_owned(), text));
}

pub(super) fn joined(outer: &str, inner: &str) -> String {
    if outer.is_empty() { inner.to_owned() } else { format!("{outer}::{inner}") }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        _ => false,
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Union(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

impl Text {
    fn bind(&mut self, name: String, binding: Binding) {
        self.scope.entry(name).or_default().push(binding);
    }

    fn bind_item(&mut self, item: &Item) {
        let name = match item {
            Item::Const(item) => &item.ident,
            Item::Enum(item) => &item.ident,
            Item::Fn(item) => &item.sig.ident,
            Item::Static(item) => &item.ident,
            Item::Struct(item) => &item.ident,
            Item::Trait(item) => &item.ident,
            Item::Type(item) => &item.ident,
            Item::Union(item) => &item.ident,
            Item::Macro(item) => match &item.ident {
                Some(name) => name,
                None => return self.bind_made(item.mac.tokens.clone()),
            },
            Item::Mod(item) => return self.bind(item.ident.to_string(), Binding::Child),
            _ => return,
        };
        self.bind(name.to_string(), Binding::Item);
    }

    /// Items that a macro is given, as in `wire_struct! { pub struct Hit { .. } }`.
    fn bind_made(&mut self, tokens: TokenStream) {
        const BEFORE_A_NAME: [&str; 7] = ["struct", "enum", "fn", "const", "static", "trait", "type"];
        let words: Vec<String> = tokens.into_iter().map(|token| token.to_string()).collect();
        for pair in words.windows(2).filter(|pair| BEFORE_A_NAME.contains(&pair[0].as_str())) {
            self.bind(pair[1].clone(), Binding::Item);
        }
    }

    fn import(&mut self, mut path: Names, tree: &UseTree, is_shown: bool) {
        match tree {
            UseTree::Path(tree) => {
                path.push(tree.ident.to_string());
                self.import(path, &tree.tree, is_shown);
            }
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.import(path.clone(), tree, is_shown)),
            UseTree::Glob(_) => self.globs.push(path),
            UseTree::Name(tree) => {
                if tree.ident != "self" {
                    path.push(tree.ident.to_string());
                }
                self.import_as(path.last().cloned().unwrap_or_default(), path, is_shown);
            }
            UseTree::Rename(tree) => {
                if tree.ident != "self" {
                    path.push(tree.ident.to_string());
                }
                self.import_as(tree.rename.to_string(), path, is_shown);
            }
        }
    }

    fn import_as(&mut self, name: String, path: Names, is_shown: bool) {
        self.bind(name, Binding::Import(path.clone()));
        self.imports.push(Import { path, is_shown });
    }

    fn path(&mut self, path: Names) {
        let is_local = |name: &String| self.locals.iter().any(|locals| locals.contains(name));
        if path.len() > 1 || !path.iter().all(is_local) {
            self.paths.push(path);
        }
    }

    /// Paths in what a macro is given: each row of names with `::` between them.
    fn tokens(&mut self, tokens: TokenStream) {
        let (mut path, mut before) = (Names::new(), String::new());
        for token in tokens {
            match &token {
                // What comes behind a dot is a field or a method.
                TokenTree::Ident(_) if before == "." => (),
                TokenTree::Ident(name) => {
                    if before != "::" {
                        self.end(&mut path);
                    }
                    path.push(name.to_string());
                }
                TokenTree::Group(group) => {
                    self.end(&mut path);
                    self.tokens(group.stream());
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => (),
                _ => self.end(&mut path),
            }
            before = match (&token, before.as_str()) {
                (TokenTree::Punct(mark), ":") if mark.as_char() == ':' => "::".to_owned(),
                _ => token.to_string(),
            };
        }
        self.end(&mut path);
    }

    fn end(&mut self, path: &mut Names) {
        if !path.is_empty() {
            self.path(std::mem::take(path));
        }
    }

    fn with_locals(&mut self, locals: Locals, read: impl FnOnce(&mut Self)) {
        self.locals.push(locals.0);
        read(self);
        self.locals.pop();
    }
}

impl<'a> Visit<'a> for Text {
    fn visit_item(&mut self, item: &'a Item) {
        if !is_test(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        if item.leading_colon.is_none() {
            self.import(Names::new(), &item.tree, !matches!(item.vis, Visibility::Inherited));
        }
    }

    fn visit_item_fn(&mut self, item: &'a syn::ItemFn) {
        let mut locals = Locals::default();
        locals.visit_item_fn(item);
        self.with_locals(locals, |text| visit::visit_item_fn(text, item));
    }

    fn visit_impl_item_fn(&mut self, item: &'a syn::ImplItemFn) {
        let mut locals = Locals::default();
        locals.visit_impl_item_fn(item);
        self.with_locals(locals, |text| visit::visit_impl_item_fn(text, item));
    }

    fn visit_trait_item_fn(&mut self, item: &'a syn::TraitItemFn) {
        let mut locals = Locals::default();
        locals.visit_trait_item_fn(item);
        self.with_locals(locals, |text| visit::visit_trait_item_fn(text, item));
    }

    fn visit_item_impl(&mut self, item: &'a syn::ItemImpl) {
        let mut locals = Locals::default();
        locals.visit_generics(&item.generics);
        self.with_locals(locals, |text| visit::visit_item_impl(text, item));
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        if path.leading_colon.is_none() {
            self.path(path.segments.iter().map(|part| part.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_pat_ident(&mut self, pattern: &'a syn::PatIdent) {
        // A constant looks like a variable.
        if pattern.ident.to_string().starts_with(char::is_uppercase) {
            self.path(vec![pattern.ident.to_string()]);
        }
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_macro(&mut self, item: &'a syn::Macro) {
        self.visit_path(&item.path);
        self.tokens(item.tokens.clone());
    }

    fn visit_visibility(&mut self, _: &'a Visibility) {}

    fn visit_attribute(&mut self, attribute: &'a Attribute) {
        let Meta::List(list) = &attribute.meta else { return };
        // As in `#[serde(with = "crate::num::hex")]`.
        for token in list.tokens.clone() {
            if let TokenTree::Literal(literal) = token
                && let Ok(path) = syn::parse_str::<syn::LitStr>(&literal.to_string()).and_then(|text| text.parse::<syn::Path>())
            {
                self.visit_path(&path);
            }
        }
    }
}

/// Names that a function binds itself.
#[derive(Default)]
struct Locals(Vec<String>);

impl<'a> Visit<'a> for Locals {
    fn visit_pat_ident(&mut self, pattern: &'a syn::PatIdent) {
        if !pattern.ident.to_string().starts_with(char::is_uppercase) {
            self.0.push(pattern.ident.to_string());
        }
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_type_param(&mut self, param: &'a syn::TypeParam) {
        self.0.push(param.ident.to_string());
        visit::visit_type_param(self, param);
    }

    fn visit_const_param(&mut self, param: &'a syn::ConstParam) {
        self.0.push(param.ident.to_string());
        visit::visit_const_param(self, param);
    }
}
