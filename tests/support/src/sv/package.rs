//! A package: localparams with their values, packed structs, enums. Functions are passed over.

use super::Result;
use super::expression::value;
use super::tokens::{Token, Tokens};
use std::collections::BTreeMap;

/// What a field's bits are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Shape {
    /// `logic`, with the sizes of its packed dimensions, the leftmost first; none is one bit.
    Logic { signed: bool, sizes: Vec<u64> },
    /// Another type of the package.
    Named(String),
}

/// A field of a packed struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructField {
    pub name: String,
    pub shape: Shape,
}

/// What a package declares.
#[derive(Debug, Default)]
pub struct Package {
    pub name: String,
    pub params: BTreeMap<String, u64>,
    pub structs: BTreeMap<String, Vec<StructField>>,
    /// Width and members.
    pub enums: BTreeMap<String, (u64, Vec<(String, u64)>)>,
}

impl Package {
    pub fn parse(text: &str) -> Result<Self> {
        let mut t = Tokens::new(text)?;
        if !t.word("package") {
            return Err(t.wrong("a package"));
        }
        let mut package = Self { name: t.name()?, ..Self::default() };
        t.expect(';')?;
        while !t.word("endpackage") {
            if t.word("localparam") {
                package.localparam(&mut t)?;
            } else if t.word("typedef") {
                package.typedef(&mut t)?;
            } else if t.word("function") {
                while !t.word("endfunction") {
                    t.next().ok_or("a function without an end")?;
                }
            } else {
                return Err(t.wrong("a declaration"));
            }
        }
        Ok(package)
    }

    /// Width of a type of the package.
    pub fn width(&self, shape: &Shape) -> Result<u64> {
        match shape {
            Shape::Logic { sizes, .. } => Ok(sizes.iter().product()),
            Shape::Named(name) => match (self.structs.get(name), self.enums.get(name)) {
                (Some(fields), _) => fields.iter().map(|field| self.width(&field.shape)).sum(),
                (_, Some((width, _))) => Ok(*width),
                _ => Err(format!("no type {name}")),
            },
        }
    }

    fn localparam(&mut self, t: &mut Tokens) -> Result<()> {
        if t.word("int") {
            t.word("unsigned");
        } else {
            self.shape(t)?;
        }
        let name = t.name()?;
        t.expect('=')?;
        let value = value(t, &self.params)?;
        t.expect(';')?;
        match self.params.insert(name.clone(), value) {
            None => Ok(()),
            Some(_) => Err(format!("{name} twice")),
        }
    }

    fn typedef(&mut self, t: &mut Tokens) -> Result<()> {
        if t.word("enum") {
            let Shape::Logic { sizes, .. } = self.shape(t)? else { return Err(t.wrong("logic")) };
            t.expect('{')?;
            let mut members = Vec::new();
            while !t.sign('}') {
                let name = t.name()?;
                t.expect('=')?;
                members.push((name, value(t, &self.params)?));
                t.sign(',');
            }
            self.enums.insert(t.name()?, (sizes.iter().product(), members));
            return t.expect(';');
        }
        if !(t.word("struct") && t.word("packed")) {
            return Err(t.wrong("struct packed or enum"));
        }
        t.expect('{')?;
        let mut fields = Vec::new();
        while !t.sign('}') {
            let shape = self.shape(t)?;
            fields.push(StructField { name: t.name()?, shape });
            t.expect(';')?;
        }
        self.structs.insert(t.name()?, fields);
        t.expect(';')
    }

    fn shape(&self, t: &mut Tokens) -> Result<Shape> {
        if !t.word("logic") {
            return t.name().map(Shape::Named);
        }
        let signed = t.word("signed");
        let mut sizes = Vec::new();
        while matches!(t.peek(), Some(Token::Sign('['))) {
            t.expect('[')?;
            let msb = value(t, &self.params)?;
            t.expect(':')?;
            let lsb = value(t, &self.params)?;
            t.expect(']')?;
            sizes.push(msb.checked_sub(lsb).ok_or_else(|| t.wrong("a descending range"))? + 1);
        }
        Ok(Shape::Logic { signed, sizes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_structs_and_enums_are_read() {
        let text = "package p; // a package\n localparam int unsigned A = 3; localparam int unsigned B = 2 * (A + 1) - 1;
            localparam logic [1:0] C = 2'd2;
            function automatic int unsigned f(input int unsigned w); f = w < 2 ? 1 : $clog2(w); endfunction
            typedef enum logic [1:0] { X = 2'd0, Y = 2'b1 } e_t;
            typedef struct packed { logic signed [B-1:0] x; logic [3:0][A-1:0] y; logic z; } s_t;
            typedef struct packed { s_t s; e_t e; } t_t; endpackage";
        let p = Package::parse(text).unwrap();
        assert_eq!(p.params.values().copied().collect::<Vec<_>>(), [3, 7, 2]);
        assert_eq!(p.enums["e_t"], (2, vec![("X".to_owned(), 0), ("Y".to_owned(), 1)]));
        assert_eq!(p.structs["s_t"][1].shape, Shape::Logic { signed: false, sizes: vec![4, 3] });
        assert_eq!(p.width(&Shape::Named("t_t".to_owned())), Ok(7 + 12 + 1 + 2));
    }

    #[test]
    fn what_is_not_understood_is_an_error() {
        for text in ["module m; endmodule", "package p; localparam A = q;", "package p; wire w; endpackage", "package p; function f;"] {
            assert!(Package::parse(text).is_err(), "{text}");
        }
    }
}
