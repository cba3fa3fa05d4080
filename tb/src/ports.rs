//! The ports of a model, read from the header that Verilator writes: there every parameter and struct is settled.

use crate::Error;

/// Which way a port goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Into the top.
    In,
    /// Out of it.
    Out,
}

/// A port of the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Port {
    /// Its name.
    pub name: String,
    /// Its width in bits, a struct or packed array as a whole.
    pub width: u32,
    /// Which way it goes.
    pub direction: Direction,
}

impl Port {
    /// Words of 64 bits that hold it.
    pub fn words(&self) -> usize {
        self.width.div_ceil(64) as usize // at most 2^32 / 64
    }
}

/// The ports in the order of the header: lines such as `VL_INW(&in_i,199,0,7);`.
pub(crate) fn parse(top: &str, header: &str) -> Result<Vec<Port>, Error> {
    let mut ports = Vec::new();
    for line in header.lines().map(str::trim) {
        let direction = match line {
            _ if line.starts_with("VL_INOUT") => return Err(refuse(top, line)),
            _ if line.starts_with("VL_IN") => Direction::In,
            _ if line.starts_with("VL_OUT") => Direction::Out,
            _ => continue,
        };
        let port = line.split_once('(').and_then(|(_, rest)| rest.strip_suffix(");")).and_then(|inside| {
            let mut parts = inside.split(',');
            let name = parts.next()?.trim_start_matches('&').to_owned();
            let msb: u32 = parts.next()?.parse().ok()?;
            let lsb: u32 = parts.next()?.parse().ok()?;
            Some(Port { name, width: msb.checked_sub(lsb)?.checked_add(1)?, direction })
        });
        ports.push(port.ok_or_else(|| refuse(top, line))?);
    }
    match ports.iter().any(|port| port.name == "clk_i" && port.width == 1) {
        true => Ok(ports),
        false => Err(Error::Ports { top: top.to_owned(), what: "no clock port clk_i".to_owned() }),
    }
}

fn refuse(top: &str, line: &str) -> Error {
    Error::Ports { top: top.to_owned(), what: format!("a port of a kind that cannot be driven: {line}") }
}

/// The generated `ports.h` of the shim.
pub(crate) fn table(ports: &[Port]) -> String {
    let mut text = String::from("#include \"Vtop.h\"\n#define LODRAY_PORTS(X)");
    for port in ports {
        text += &format!(" \\\n    X({}, {}, {})", port.name, port.width, u32::from(port.direction == Direction::Out));
    }
    text += "\n";
    if let Some((input, _, tag)) = block(ports) {
        text += &format!("#define LODRAY_BLOCK\n#define LODRAY_IN_W {input}\n#define LODRAY_TAG_W {tag}\n");
    }
    text
}

/// Widths of `in_i`, `out_o` and the tag, if these are the ports of a block.
pub(crate) fn block(ports: &[Port]) -> Option<(u32, u32, u32)> {
    let names: Vec<&str> = ports.iter().map(|port| port.name.as_str()).collect();
    let mut sorted = names.clone();
    sorted.sort_unstable();
    let mut expected = ["clk_i", "rst_ni", "valid_i", "ready_o", "in_i", "tag_i", "valid_o", "ready_i", "out_o", "tag_o"];
    expected.sort_unstable();
    let width = |name: &str| ports.iter().find(|port| port.name == name).map(|port| port.width);
    let (tag_in, tag_out) = (width("tag_i")?, width("tag_o")?);
    (sorted == expected && tag_in == tag_out && tag_in <= 64).then_some((width("in_i")?, width("out_o")?, tag_in))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_come_from_the_macros_of_the_header() {
        let header = "VL_IN8(&clk_i,0,0);\n  VL_OUT64(&tag_o,39,0);\nVL_INW(&in_i,199,0,7);\nint x;";
        let ports = parse("t", header).unwrap();
        assert_eq!(ports.len(), 3);
        assert_eq!(ports[1], Port { name: "tag_o".to_owned(), width: 40, direction: Direction::Out });
        assert_eq!(ports[2].words(), 4);
        assert!(block(&ports).is_none());
    }

    #[test]
    fn a_top_without_a_clock_or_with_a_two_way_port_is_refused() {
        assert!(parse("t", "VL_IN8(&a,0,0);").is_err());
        assert!(parse("t", "VL_IN8(&clk_i,0,0);\nVL_INOUT8(&pad,0,0);").is_err());
    }
}
