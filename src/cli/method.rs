//! Options of methods, from the registry: which method, and its knobs.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser, ValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, Args, Command, FromArgMatches};
use lodray::method::{Knob, Knobs, METHODS, Registered, binary16, cluster, find, grid, lod, rlod, stochastic};
use lodray::study::Chosen;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};

const METHOD: &str = "method";

/// The name by which pictures are asked for of the mesh that a scene is made from.
pub const ORIGINAL: &str = "original";
const ORIGINAL_HELP: &str =
    "The mesh that scenes are made from, as it is, in f64: SCENE is then the mesh file, or the scene of the view with the mesh in --mesh";

/// A method of a machine, with its knobs.
#[derive(Clone, Debug)]
pub struct MachineMethod(pub Chosen);

/// Any method, with its knobs: also what is no hardware.
#[derive(Clone, Debug)]
pub struct AnyMethod(pub Chosen);

/// A method for pictures, with its knobs: also the mesh that a scene is made from.
#[derive(Clone, Debug)]
pub struct PictureMethod {
    pub chosen: Chosen,
    /// The mesh that the scene was made from is wanted, in the reference's arithmetic.
    pub original: bool,
}

/// The methods that have hardware.
pub fn machine_methods() -> impl Iterator<Item = &'static Registered> {
    METHODS.iter().copied().filter(|method| method.unit.is_some())
}

/// Those that are compared where none is named: without stochastic levels and the systems of papers on grids, clusters and R-LODs, whose sweeps take long and whose columns no page has room for.
pub fn compared_methods() -> impl Iterator<Item = &'static Registered> {
    const NAMED_ONLY: [&Registered; 6] =
        [&binary16::METHOD, &stochastic::METHOD, &grid::METHOD, &cluster::METHOD, &cluster::METHOD_PAPER, &rlod::METHOD];
    machine_methods().filter(|method| !NAMED_ONLY.contains(method))
}

/// The methods whose triangles are the scene's own.
fn own_methods() -> impl Iterator<Item = &'static Registered> {
    METHODS.iter().copied().filter(|method| !method.of_input())
}

/// Every knob of these methods, once.
fn knobs(methods: impl Iterator<Item = &'static Registered>) -> Vec<&'static Knob> {
    let mut knobs: Vec<&Knob> = Vec::new();
    for knob in methods.flat_map(|method| method.knobs.iter().copied()) {
        if knobs.iter().all(|before| before.name != knob.name) {
            knobs.push(knob);
        }
    }
    knobs
}

/// `(name, help)` as clap has it.
fn values(words: impl Iterator<Item = (&'static str, &'static str)>) -> PossibleValuesParser {
    PossibleValuesParser::new(words.map(|(name, help)| PossibleValue::new(name).help(help)).collect::<Vec<_>>())
}

fn method_arg(words: PossibleValuesParser) -> Arg {
    let method = words.map(|name: String| name);
    Arg::new(METHOD).long(METHOD).value_name("METHOD").default_value(lod::METHOD.name).value_parser(method).help("How rays find their hits")
}

fn knob_arg(knob: &'static Knob) -> Arg {
    let parser: ValueParser = if knob.words.is_empty() {
        ValueParser::new(move |value: &str| (knob.allows)(value).map(|()| value.to_owned()))
    } else {
        values(knob.words.iter().copied()).into()
    };
    let arg = Arg::new(knob.name).long(knob.name).value_name(knob.value_name).help(knob.help).value_parser(parser);
    let arg = arg.allow_hyphen_values(knob.words.is_empty());
    if let Some(default) = knob.default { arg.default_value(default) } else { arg }
}

fn augmented(command: Command, method: Arg, methods: impl Iterator<Item = &'static Registered>) -> Command {
    command.arg(method).args(knobs(methods).into_iter().map(knob_arg))
}

/// The methods that have a knob, in words.
fn owners(knob: &Knob) -> String {
    let names: Vec<_> = METHODS.iter().filter(|method| method.has(knob.name)).map(|method| method.name).collect();
    format!("{} {} one", names.join(", "), if names.len() == 1 { "has" } else { "have" })
}

/// The method of this name, and its knobs. Those of other methods are refused where they were given: nobody would see that they do nothing.
fn chosen(matches: &ArgMatches, name: &str, knobs: Vec<&'static Knob>) -> Result<Chosen, clap::Error> {
    let raw = |why: String| clap::Error::raw(clap::error::ErrorKind::InvalidValue, why);
    let method = find(name).ok_or_else(|| raw(format!("there is no method {name}")))?;
    let mut values = Knobs::default();
    for knob in knobs {
        if !method.has(knob.name) && matches.value_source(knob.name) == Some(ValueSource::CommandLine) {
            return Err(raw(format!("--{}: {name} has no such knob; {}", knob.name, owners(knob))));
        }
        if let Some(value) = matches.get_one::<String>(knob.name) {
            values.set(knob, value).map_err(|why| raw(why.to_string()))?;
        }
    }
    Ok(Chosen { method, knobs: values })
}

fn name(matches: &ArgMatches) -> &str {
    matches.get_one::<String>(METHOD).map_or(lod::METHOD.name, String::as_str)
}

/// The kinds of options differ in which methods there are.
macro_rules! options {
    ($options:ident, $words:expr, $methods:expr, $from:expr) => {
        impl Args for $options {
            fn augment_args(command: Command) -> Command {
                augmented(command, method_arg(values($words)), $methods)
            }
            fn augment_args_for_update(command: Command) -> Command {
                Self::augment_args(command)
            }
        }

        impl FromArgMatches for $options {
            fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
                $from(matches, knobs($methods))
            }
            fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
                *self = Self::from_arg_matches(matches)?;
                Ok(())
            }
        }
    };
}

options!(MachineMethod, machine_methods().map(|method| (method.name, method.help)), machine_methods(), |matches, knobs| {
    chosen(matches, name(matches), knobs).map(MachineMethod)
});

options!(AnyMethod, own_methods().map(|method| (method.name, method.help)), own_methods(), |matches, knobs| {
    chosen(matches, name(matches), knobs).map(AnyMethod)
});

options!(
    PictureMethod,
    own_methods().map(|method| (method.name, method.help)).chain([(ORIGINAL, ORIGINAL_HELP)]),
    own_methods(),
    |matches, knobs| {
        let name = name(matches);
        let original = name == ORIGINAL;
        // The original is a scene whose full resolution is the mesh.
        let name = if original { lodray::method::reference::METHOD.name } else { name };
        Ok(PictureMethod { chosen: chosen(matches, name, knobs)?, original })
    }
);

impl PictureMethod {
    /// Its name in options and reports.
    pub fn name(&self) -> &'static str {
        if self.original { ORIGINAL } else { self.chosen.method.name }
    }
}

/// A method of a machine in a list of jobs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Listed(pub &'static Registered);

impl<'de> Deserialize<'de> for Listed {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let name = String::deserialize(from)?;
        let known = || machine_methods().map(|method| format!("`{}`", method.name)).collect::<Vec<_>>().join(", ");
        let found = find(&name).filter(|method| method.unit.is_some());
        found.map(Self).ok_or_else(|| D::Error::custom(format!("unknown variant `{name}`, expected one of {}", known())))
    }
}
