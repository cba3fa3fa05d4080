//! The modules of a crate, and which of them use items that others define: names are resolved through imports and re-exports, as the compiler does.

mod read;

use petgraph::algo::tarjan_scc;
use petgraph::graphmap::DiGraphMap;
use read::{Binding, Names, Text};
use std::collections::{BTreeMap, BTreeSet};

/// What a path leads to.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Target {
    Module(String),
    /// An item, by the module that defines it.
    ItemOf(String),
}

/// What names mean, by module and name.
type Known = BTreeMap<(String, String), BTreeSet<Target>>;

/// Modules by their names without `crate::` (the crate itself is the empty name), read from their texts.
pub struct House {
    /// Modules, those within files too.
    modules: BTreeMap<String, Text>,
    /// Which module's file a module stands in.
    files: BTreeMap<String, String>,
    uses: BTreeMap<String, BTreeSet<String>>,
}

impl House {
    /// The house of files: the text of each, by the name of its module.
    pub fn new(texts: &BTreeMap<String, String>) -> Self {
        let mut house = Self { modules: BTreeMap::new(), files: BTreeMap::new(), uses: BTreeMap::new() };
        for (name, text) in texts {
            for (module, text) in read::read(name, text) {
                house.files.insert(module.clone(), name.clone());
                house.modules.insert(module, text);
            }
        }
        let mut uses: BTreeMap<String, BTreeSet<String>> = texts.keys().map(|name| (name.clone(), BTreeSet::new())).collect();
        for (name, text) in &house.modules {
            let user = &house.files[name];
            uses.entry(user.clone()).or_default().extend(house.used(name, text).into_iter().filter(|used| used != user));
        }
        house.uses = uses;
        house
    }

    /// How many files it has.
    pub fn files(&self) -> usize {
        self.uses.len()
    }

    /// Each file with each other one that it uses.
    pub fn arrows(&self) -> impl Iterator<Item = (&str, &str)> {
        self.uses.iter().flat_map(|(from, used)| used.iter().map(|to| (from.as_str(), to.as_str())))
    }

    /// Sets of files each of which uses all others of its set, by way of others or not.
    pub fn circles(&self) -> BTreeSet<Vec<&str>> {
        circles(self.arrows()).collect()
    }

    /// The same of the parts of each folder: its files and, each as a whole, the folders in it. The folder's own file is its part `mod`.
    pub fn circles_of_parts(&self) -> BTreeSet<(String, Vec<&str>)> {
        let mut folders: BTreeMap<String, Vec<(&str, &str)>> = BTreeMap::new();
        for (from, to) in self.arrows() {
            let [from, to] = [from, to].map(|name| name.split("::").collect::<Vec<_>>());
            let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
            folders.entry(from[..shared].join("::")).or_default().push((part(&from, shared), part(&to, shared)));
        }
        folders.iter().flat_map(|(folder, arrows)| circles(arrows.iter().copied()).map(|set| (folder.clone(), set))).collect()
    }

    /// Files whose items the module uses.
    fn used(&self, name: &str, text: &Text) -> BTreeSet<String> {
        let paths = text.paths.iter().map(|path| (path, false)).chain(text.imports.iter().map(|import| (&import.path, import.is_shown)));
        let mut used = BTreeSet::new();
        for (path, is_shown) in paths {
            for target in self.resolve(name, path, &mut Known::new()) {
                // A module that only shows what is below it does not use it.
                if let Target::ItemOf(owner) = target
                    && !(is_shown && is_within(&owner, name))
                {
                    used.insert(self.files[&owner].clone());
                }
            }
        }
        used
    }

    /// What `path` means in `module`.
    fn resolve(&self, module: &str, path: &Names, known: &mut Known) -> BTreeSet<Target> {
        let Some((first, rest)) = path.split_first() else { return BTreeSet::new() };
        let mut at = match first.as_str() {
            "crate" | "lodray" => BTreeSet::from([Target::Module(String::new())]),
            "self" => BTreeSet::from([Target::Module(module.to_owned())]),
            "super" => BTreeSet::from([Target::Module(parent(module))]),
            name => self.lookup(module, name, known),
        };
        for name in rest {
            // A function may be called like a module, and leads nowhere.
            if at.iter().any(|target| matches!(target, Target::Module(_))) {
                at.retain(|target| matches!(target, Target::Module(_)));
            }
            let next = |target: Target| match target {
                Target::Module(module) if name == "super" => BTreeSet::from([Target::Module(parent(&module))]),
                Target::Module(module) => self.lookup(&module, name, known),
                // A variant, or what a type has.
                item => BTreeSet::from([item]),
            };
            at = at.into_iter().flat_map(next).collect();
        }
        at
    }

    /// What `name` means in `module`.
    fn lookup(&self, module: &str, name: &str, known: &mut Known) -> BTreeSet<Target> {
        let Some(text) = self.modules.get(module) else { return BTreeSet::new() };
        let key = (module.to_owned(), name.to_owned());
        if let Some(meant) = known.get(&key) {
            return meant.clone();
        }
        // A name on whose way this one comes again means nothing by that way.
        known.insert(key.clone(), BTreeSet::new());
        let mut meant = BTreeSet::new();
        for binding in text.scope.get(name).into_iter().flatten() {
            match binding {
                Binding::Item => _ = meant.insert(Target::ItemOf(module.to_owned())),
                Binding::Child => _ = meant.insert(Target::Module(read::joined(module, name))),
                Binding::Import(path) => meant.extend(self.resolve(module, path, known)),
            }
        }
        if meant.is_empty() {
            for opened in text.globs.iter().flat_map(|path| self.resolve(module, path, known)).collect::<Vec<_>>() {
                if let Target::Module(opened) = opened {
                    meant.extend(self.lookup(&opened, name, known));
                }
            }
        }
        known.insert(key, meant.clone());
        meant
    }
}

/// The part of a folder that a module is in, or is, whose name has so many words before it.
fn part<'a>(name: &[&'a str], at: usize) -> &'a str {
    name.get(at).copied().unwrap_or("mod")
}

fn circles<'a>(arrows: impl Iterator<Item = (&'a str, &'a str)>) -> impl Iterator<Item = Vec<&'a str>> {
    let sets = tarjan_scc(&DiGraphMap::<&str, ()>::from_edges(arrows)).into_iter().filter(|set| set.len() > 1);
    sets.map(|mut set| {
        set.sort_unstable();
        set
    })
}

fn parent(module: &str) -> String {
    module.rsplit_once("::").map_or_else(String::new, |(outer, _)| outer.to_owned())
}

/// Whether `module` is `outer`, or is in it.
pub fn is_within(module: &str, outer: &str) -> bool {
    module.strip_prefix(outer).is_some_and(|rest| outer.is_empty() || rest.is_empty() || rest.starts_with("::"))
}
