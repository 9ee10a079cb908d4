//! The tokens of a formula.

use super::error::{FormulaError, Reason};

/// What a token is.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Number(f64),
    Name,
    /// A name in back-ticks.
    Quoted,
    /// A text in quotes.
    Text,
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Compare,
    Open,
    Close,
    Comma,
    End,
}

/// A token and its place in the text, in bytes.
#[derive(Clone, Copy)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// The token at or after a place in a text; `conditions` says whether comparisons, texts and quoted
/// names are among them.
pub(super) fn token_at(text: &str, at: usize, conditions: bool) -> Result<Token, FormulaError<'_>> {
    let rest = text.get(at..).unwrap_or_default();
    let blank = rest.len() - rest.trim_start().len();
    let rest = rest.trim_start();
    let start = at + blank;
    let Some(first) = rest.chars().next() else {
        return Ok(Token { kind: Kind::End, start, end: start });
    };
    let found = if conditions { condition(rest, first) } else { Ok(None) };
    let found = match found {
        Ok(Some(found)) => Ok(found),
        Ok(None) => arithmetic(rest, first, conditions),
        Err(reason) => Err(reason),
    };
    match found {
        Ok((kind, length)) => Ok(Token { kind, start, end: start + length }),
        Err(reason) => Err(FormulaError::at(text, start, reason)),
    }
}

/// A token that only conditions have, and its length.
fn condition<'a>(rest: &'a str, first: char) -> Result<Option<(Kind, usize)>, Reason<'a>> {
    let begins = |word: &str| rest.starts_with(word);
    Ok(Some(match first {
        '=' | '!' | '<' | '>' if begins("==") || begins("!=") || begins("<=") || begins(">=") => {
            (Kind::Compare, 2)
        }
        '<' | '>' => (Kind::Compare, 1),
        '=' => return Err(Reason::Spelling("=", "==")),
        '&' => return Err(Reason::Spelling("&", "and")),
        '|' => return Err(Reason::Spelling("|", "or")),
        '!' | '~' => return Err(Reason::Spelling(if first == '!' { "!" } else { "~" }, "not")),
        '`' | '\'' | '"' => match quoted_length(rest, first) {
            Some(length) if first == '`' => (Kind::Quoted, length),
            Some(length) => (Kind::Text, length),
            None => return Err(Reason::Unquoted(first)),
        },
        letter if letter.is_alphabetic() && !letter.is_ascii() => {
            (Kind::Name, name_length(rest, true))
        }
        _ => return Ok(None),
    }))
}

/// A token of every formula, and its length.
fn arithmetic<'a>(
    rest: &'a str,
    first: char,
    conditions: bool,
) -> Result<(Kind, usize), Reason<'a>> {
    Ok(match first {
        '+' => (Kind::Plus, 1),
        '-' => (Kind::Minus, 1),
        '*' if rest.starts_with("**") => (Kind::Power, 2),
        '*' => (Kind::Times, 1),
        '/' => (Kind::Over, 1),
        '^' => (Kind::Power, 1),
        '(' | '[' => (Kind::Open, 1),
        ')' | ']' => (Kind::Close, 1),
        ',' => (Kind::Comma, 1),
        '0'..='9' | '.' => {
            let length = number_length(rest);
            let digits = rest.get(..length).unwrap_or_default();
            let number = number(digits).ok_or(Reason::Number(digits))?;
            (Kind::Number(number), length)
        }
        'a'..='z' | 'A'..='Z' | '_' => (Kind::Name, name_length(rest, conditions)),
        other => return Err(Reason::Character(other)),
    })
}

/// The length of a name in bytes; with `unicode`, of letters of any alphabet.
fn name_length(rest: &str, unicode: bool) -> usize {
    let inside =
        |c: char| c == '_' || if unicode { c.is_alphanumeric() } else { c.is_ascii_alphanumeric() };
    rest.find(|c| !inside(c)).unwrap_or(rest.len())
}

/// The length of a quoted text in bytes, with its quotes; a backslash keeps a quote from ending it.
fn quoted_length(rest: &str, quote: char) -> Option<usize> {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        if c == quote && !escaped {
            return Some(at + 1);
        }
        escaped = c == '\\' && !escaped && quote != '`';
    }
    None
}

/// A number; underscores may group its digits, and it may be hexadecimal, octal or binary.
fn number(digits: &str) -> Option<f64> {
    let radix = match digits.get(..2) {
        Some("0x" | "0X") => 16,
        Some("0o" | "0O") => 8,
        Some("0b" | "0B") => 2,
        _ if !digits.contains('_') => return digits.parse().ok(),
        _ => 10,
    };
    let mut plain = [0; 64];
    let mut length = 0;
    for byte in digits.bytes().filter(|&byte| byte != b'_') {
        *plain.get_mut(length)? = byte;
        length += 1;
    }
    let plain = core::str::from_utf8(plain.get(..length)?).ok()?;
    if radix == 10 {
        return plain.parse().ok();
    }
    u32::from_str_radix(plain.get(2..)?, radix).ok().map(f64::from)
}

/// The length of a number in bytes: digits, a point, an exponent with its sign.
fn number_length(text: &str) -> usize {
    let hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    let mut before = ' ';
    for (at, c) in text.char_indices() {
        let exponent = matches!(before, 'e' | 'E') && matches!(c, '+' | '-') && !hexadecimal;
        let grouped = c == '_' && before.is_ascii_alphanumeric();
        if !(c.is_ascii_alphanumeric() || c == '.' || grouped || exponent) {
            return at;
        }
        before = c;
    }
    text.len()
}
