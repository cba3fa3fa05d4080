//! Constant expressions: + - * / << and brackets over numbers and localparams.

use super::Result;
use super::tokens::{Token, Tokens};
use std::collections::BTreeMap;

/// The value of the expression that comes next.
pub fn value(t: &mut Tokens, known: &BTreeMap<String, u64>) -> Result<u64> {
    let mut sum = product(t, known)?;
    loop {
        if t.sign('+') {
            sum += product(t, known)?;
        } else if t.sign('-') {
            sum = sum.checked_sub(product(t, known)?).ok_or("a negative number")?;
        } else if t.sign('<') {
            t.expect('<')?;
            sum <<= product(t, known)?;
        } else {
            return Ok(sum);
        }
    }
}

fn product(t: &mut Tokens, known: &BTreeMap<String, u64>) -> Result<u64> {
    let mut value = atom(t, known)?;
    loop {
        if t.sign('*') {
            value *= atom(t, known)?;
        } else if t.sign('/') {
            value = value.checked_div(atom(t, known)?).ok_or("a division by zero")?;
        } else {
            return Ok(value);
        }
    }
}

fn atom(t: &mut Tokens, known: &BTreeMap<String, u64>) -> Result<u64> {
    match t.next() {
        Some(Token::Number(number)) => Ok(number),
        Some(Token::Name(name)) => known.get(&name).copied().ok_or_else(|| format!("no localparam {name}")),
        Some(Token::Sign('(')) => {
            let inner = value(t, known)?;
            t.expect(')').map(|()| inner)
        }
        other => Err(t.wrong(&format!("a constant expression, not {other:?}"))),
    }
}
