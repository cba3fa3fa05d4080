//! Words of the language: names, numbers (of which sized ones count as their value), and single signs.

use super::{Result, code};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Token {
    Name(String),
    Number(u64),
    Sign(char),
}

/// The words of a text and the place reached in them.
pub struct Tokens {
    tokens: Vec<Token>,
    at: usize,
}

impl Tokens {
    pub fn new(text: &str) -> Result<Self> {
        let text = code(text);
        let mut rest = text.trim_start();
        let mut tokens = Vec::new();
        while let Some(first) = rest.chars().next() {
            let word = |part: fn(char) -> bool| rest.find(|c: char| !part(c)).unwrap_or(rest.len());
            let length = if first.is_ascii_digit() || first == '\'' {
                word(|c| c.is_ascii_alphanumeric() || c == '_' || c == '\'')
            } else if first.is_ascii_alphabetic() || first == '_' || first == '$' {
                word(|c| c.is_ascii_alphanumeric() || c == '_' || c == '$')
            } else {
                first.len_utf8()
            };
            let (text, behind) = rest.split_at(length);
            tokens.push(match first {
                '0'..='9' | '\'' => number(text)?,
                _ if length > 1 || first.is_ascii_alphabetic() => Token::Name(text.to_owned()),
                sign => Token::Sign(sign),
            });
            rest = behind.trim_start();
        }
        Ok(Self { tokens, at: 0 })
    }

    pub fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.at)
    }

    pub fn next(&mut self) -> Option<Token> {
        self.at += 1;
        self.tokens.get(self.at - 1).cloned()
    }

    /// Takes this sign if it is the next word.
    pub fn sign(&mut self, sign: char) -> bool {
        let found = self.peek() == Some(&Token::Sign(sign));
        self.at += usize::from(found);
        found
    }

    /// Takes this name if it is the next word.
    pub fn word(&mut self, word: &str) -> bool {
        let found = matches!(self.peek(), Some(Token::Name(name)) if name == word);
        self.at += usize::from(found);
        found
    }

    pub fn name(&mut self) -> Result<String> {
        match self.next() {
            Some(Token::Name(name)) => Ok(name),
            other => Err(self.wrong(&format!("a name, not {other:?}"))),
        }
    }

    pub fn expect(&mut self, sign: char) -> Result<()> {
        if self.sign(sign) { Ok(()) } else { Err(self.wrong(&format!("'{sign}'"))) }
    }

    pub fn wrong(&self, expected: &str) -> String {
        let near = &self.tokens[self.at.saturating_sub(6).min(self.tokens.len())..(self.at + 2).min(self.tokens.len())];
        format!("expected {expected} near {near:?}")
    }
}

fn number(text: &str) -> Result<Token> {
    let value = match text.split_once('\'') {
        None => text.replace('_', "").parse().ok(),
        Some((_, based)) => {
            let (base, digits) = based.split_at(based.len().min(1));
            let radix = match base {
                "d" => 10,
                "b" => 2,
                "h" => 16,
                _ => return Ok(Token::Sign('\'')),
            };
            u64::from_str_radix(&digits.replace('_', ""), radix).ok()
        }
    };
    value.map(Token::Number).ok_or_else(|| format!("not a number: {text}"))
}
