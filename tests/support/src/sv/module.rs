//! The head of a module: its name, parameters with their defaults, and ports, each with the text of its type.

use super::Result;
use super::code;

/// A port as it is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// `input` or `output`.
    pub direction: String,
    /// Its type without spaces: `logic`, `logic[TAG_W-1:0]`, `lod_pkg::point_t`.
    pub kind: String,
    pub name: String,
}

/// The head of a module.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Module {
    pub name: String,
    /// Names and the text of their defaults.
    pub parameters: Vec<(String, String)>,
    pub ports: Vec<Port>,
}

impl Module {
    /// The only module of a file.
    pub fn parse(text: &str) -> Result<Self> {
        let text = code(text);
        let start = text.find("module ").ok_or("no module")?;
        let end = text[start..].find(");").ok_or("no port list")? + start;
        if text[end..].contains("\nmodule ") {
            return Err("more than one module".to_owned());
        }
        let head = text[start + "module ".len()..end].trim();
        let (name, rest) = head.split_at(head.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).ok_or("no port list")?);
        let rest = rest.trim_start();
        let (parameters, ports) = match rest.strip_prefix('#') {
            Some(rest) => {
                let close = closing(rest.trim_start())?;
                let (parameters, ports) = rest.trim_start().split_at(close);
                (&parameters[1..], ports[1..].trim_start())
            }
            None => ("", rest),
        };
        let ports = ports.strip_prefix('(').ok_or("no port list")?;
        Ok(Self {
            name: name.to_owned(),
            parameters: entries(parameters).map(parameter).collect::<Result<_>>()?,
            ports: entries(ports).map(port).collect::<Result<_>>()?,
        })
    }

    pub fn port(&self, name: &str) -> Option<&Port> {
        self.ports.iter().find(|port| port.name == name)
    }
}

/// Where the bracket closes that opens a text.
fn closing(text: &str) -> Result<usize> {
    let mut depth = 0;
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' if depth == 1 => return Ok(at),
            ')' => depth -= 1,
            _ => {}
        }
    }
    Err("a bracket that does not close".to_owned())
}

/// The parts between commas.
fn entries(text: &str) -> impl Iterator<Item = &str> {
    text.split(',').map(str::trim).filter(|entry| !entry.is_empty())
}

fn parameter(text: &str) -> Result<(String, String)> {
    let (left, default) = text.split_once('=').ok_or_else(|| format!("a parameter without a default: {text}"))?;
    let name = left.split_whitespace().last().unwrap_or_default();
    Ok((name.to_owned(), default.trim().to_owned()))
}

fn port(text: &str) -> Result<Port> {
    let words: Vec<&str> = text.split_whitespace().collect();
    match words.as_slice() {
        [direction @ ("input" | "output"), kind @ .., name] if !kind.is_empty() => {
            Ok(Port { direction: (*direction).to_owned(), kind: kind.concat(), name: (*name).to_owned() })
        }
        _ => Err(format!("not a port: {text}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_of_a_module_is_read() {
        let text =
            "/// A head.\nmodule m #(\n parameter int unsigned W = $clog2(4), // width\n parameter int N = 1\n) (\n input logic a_i,\n
            output logic signed [W-1:0] b_o,\n input p::t c_i\n);\n assign x = (1);\nendmodule";
        let m = Module::parse(text).unwrap();
        assert_eq!(m.parameters, [("W".to_owned(), "$clog2(4)".to_owned()), ("N".to_owned(), "1".to_owned())]);
        assert_eq!(m.port("b_o").unwrap().kind, "logicsigned[W-1:0]");
        assert_eq!(m.ports.len(), 3);
        assert!(Module::parse("module m (a, b); endmodule").is_err());
    }
}
