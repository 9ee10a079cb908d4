//! The grammar of formulas: recursive descent that hands each part to a [`Builder`] while it parses.
//!
//! ```text
//! choice     = both { "or" both }
//! both       = inverse { "and" inverse }
//! inverse    = "not" inverse | comparison
//! comparison = sum { ("==" | "!=" | "<" | "<=" | ">" | ">=") sum }
//! sum        = product { ("+" | "-") product }
//! product    = unary { ("*" | "/") unary }
//! unary      = ("+" | "-") unary | power
//! power      = value [ ("^" | "**") unary ]
//! value      = number | name | function bracket | bracket | text | "`" column "`"
//! ```
//!
//! A friction law is a `sum` without texts and quoted names. A formula over the columns of a
//! recording is a `choice`.

use super::error::{FormulaError, Reason};
use super::program::Operation;
use super::tokens::{Kind, Token, token_at};
use super::vocabulary::{self, ColumnFunction, Function, Word};

/// What is made of a text while it is parsed.
///
/// Every method gets the byte at which the part begins that it is about.
pub(crate) trait Builder<'a> {
    /// Deepest nesting of brackets and signs.
    const DEPTH: usize;
    /// Whether comparisons, `and`, `or`, `not`, texts and quoted names are part of the language.
    const CONDITIONS: bool;
    /// Whether functions of whole columns are part of the language.
    const COLUMNS: bool = false;

    /// A number.
    fn number(&mut self, number: f64, at: usize) -> Result<(), Reason<'a>>;

    /// A name that is not called.
    fn name(&mut self, name: &'a str, at: usize) -> Result<(), Reason<'a>>;

    /// An operation on the values before it.
    fn operation(&mut self, operation: Operation, at: usize) -> Result<(), Reason<'a>>;

    /// A function of the `given` values before it.
    fn call(&mut self, function: Function, given: usize, at: usize) -> Result<(), Reason<'a>>;

    /// A function of columns, of the `given` values before it.
    fn column_call(
        &mut self,
        function: &'static ColumnFunction,
        _given: usize,
        _at: usize,
    ) -> Result<(), Reason<'a>> {
        Err(Reason::OfColumns(function.name))
    }

    /// A text, with its quotes.
    fn text(&mut self, text: &'a str, _at: usize) -> Result<(), Reason<'a>> {
        Err(Reason::NoValue(text))
    }

    /// `not` of one value; `and`, `or` or a comparison of two. In `a < b < c` the second
    /// comparison is `chained` to the first.
    fn condition(&mut self, word: &'a str, _chained: bool, _at: usize) -> Result<(), Reason<'a>> {
        Err(Reason::NoOperator(word))
    }
}

/// Parses a text; the builder then has all of it.
pub(crate) fn parse<'a, B: Builder<'a>>(
    text: &'a str,
    builder: &mut B,
) -> Result<(), FormulaError<'a>> {
    let token = token_at(text, 0, B::CONDITIONS)?;
    let mut parser = Parser { text, token, builder };
    if parser.token.kind == Kind::End {
        return Err(parser.error_at(0, Reason::Empty));
    }
    parser.expression(0)?;
    match parser.token.kind {
        Kind::End => Ok(()),
        Kind::Close | Kind::Comma => Err(parser.error_here(Reason::Unopened(parser.word()))),
        _ => Err(parser.error_here(Reason::NoOperator(parser.word()))),
    }
}

struct Parser<'a, 'b, B> {
    text: &'a str,
    token: Token,
    builder: &'b mut B,
}

impl<'a, B: Builder<'a>> Parser<'a, '_, B> {
    fn expression(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        if !B::CONDITIONS {
            return self.sum(depth);
        }
        self.both(depth)?;
        while self.word() == "or" {
            let operator = self.advance()?;
            self.both(depth)?;
            self.condition(operator, false)?;
        }
        Ok(())
    }

    fn both(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.inverse(depth)?;
        while self.word() == "and" {
            let operator = self.advance()?;
            self.inverse(depth)?;
            self.condition(operator, false)?;
        }
        Ok(())
    }

    fn inverse(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.check_depth(depth)?;
        if self.word() == "not" {
            let operator = self.advance()?;
            self.inverse(depth + 1)?;
            return self.condition(operator, false);
        }
        self.sum(depth)?;
        let mut chained = false;
        while self.token.kind == Kind::Compare {
            let operator = self.advance()?;
            self.sum(depth)?;
            self.condition(operator, chained)?;
            chained = true;
        }
        Ok(())
    }

    fn sum(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.product(depth)?;
        while let Kind::Plus | Kind::Minus = self.token.kind {
            let operator = self.advance()?;
            self.product(depth)?;
            let minus = operator.kind == Kind::Minus;
            self.emit(if minus { Operation::Subtract } else { Operation::Add }, operator)?;
        }
        Ok(())
    }

    fn product(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.unary(depth)?;
        while let Kind::Times | Kind::Over = self.token.kind {
            let operator = self.advance()?;
            self.unary(depth)?;
            let over = operator.kind == Kind::Over;
            self.emit(if over { Operation::Divide } else { Operation::Multiply }, operator)?;
        }
        Ok(())
    }

    fn unary(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.check_depth(depth)?;
        match self.token.kind {
            Kind::Minus => {
                let sign = self.advance()?;
                self.unary(depth + 1)?;
                self.emit(Operation::Negate, sign)
            }
            Kind::Plus => {
                self.advance()?;
                self.unary(depth + 1)
            }
            _ => self.power(depth),
        }
    }

    fn power(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        self.value(depth)?;
        if self.token.kind != Kind::Power {
            return Ok(());
        }
        let operator = self.advance()?;
        self.unary(depth + 1)?;
        self.emit(Operation::Call(Function::Power), operator)
    }

    fn value(&mut self, depth: usize) -> Result<(), FormulaError<'a>> {
        let token = self.token;
        let word = self.word();
        match token.kind {
            Kind::Number(number) => {
                self.advance()?;
                let built = self.builder.number(number, token.start);
                self.checked(built, token)
            }
            Kind::Name if !(B::CONDITIONS && matches!(word, "and" | "or" | "not")) => {
                self.advance()?;
                self.name(word, token, depth)
            }
            Kind::Quoted => {
                self.advance()?;
                let built = self.builder.name(word.trim_matches('`'), token.start);
                self.checked(built, token)
            }
            Kind::Text => {
                self.advance()?;
                let built = self.builder.text(word, token.start);
                self.checked(built, token)
            }
            Kind::Open => match self.bracket(depth)? {
                (1, _) => Ok(()),
                (_, comma) => Err(self.error_at(comma, Reason::NoOperator(","))),
            },
            Kind::End => Err(self.error_here(Reason::Unfinished)),
            _ => Err(self.error_here(Reason::NoValue(word))),
        }
    }

    fn name(&mut self, name: &'a str, token: Token, depth: usize) -> Result<(), FormulaError<'a>> {
        if self.token.kind != Kind::Open {
            let built = self.builder.name(name, token.start);
            return self.checked(built, token);
        }
        if let Some(function) = ColumnFunction::named(name) {
            return self.column_function(function, token, depth);
        }
        let function = match vocabulary::word(name) {
            Word::Function(function) => function,
            Word::Other => {
                let near = vocabulary::nearest_function(name);
                return Err(self.error_at(token.start, Reason::UnknownFunction(name, near)));
            }
            Word::Channel(_) | Word::Pi => {
                return Err(self.error_at(token.start, Reason::UnknownFunction(name, None)));
            }
        };
        let (given, _) = self.bracket(depth)?;
        let enough = given == function.arity() || function.takes_more() && given > 2;
        if !enough {
            let (needed, more) = (function.arity(), function.takes_more());
            let reason = Reason::Arity(function.name(), needed, more, given);
            return Err(self.error_at(token.start, reason));
        }
        let built = self.builder.call(function, given, token.start);
        self.checked(built, token)
    }

    fn column_function(
        &mut self,
        function: &'static ColumnFunction,
        token: Token,
        depth: usize,
    ) -> Result<(), FormulaError<'a>> {
        if !B::COLUMNS {
            return Err(self.error_at(token.start, Reason::OfColumns(function.name)));
        }
        let (given, _) = self.bracket(depth)?;
        let ColumnFunction { name, arity, takes_more } = *function;
        if !(given == arity || takes_more && given > arity) {
            let reason = Reason::Arity(name, arity, takes_more, given);
            return Err(self.error_at(token.start, reason));
        }
        let built = self.builder.column_call(function, given, token.start);
        self.checked(built, token)
    }

    /// Parses a bracket of comma-separated values; returns how many, and the byte of the first
    /// comma.
    fn bracket(&mut self, depth: usize) -> Result<(usize, usize), FormulaError<'a>> {
        let closing = if self.word() == "[" { "]" } else { ")" };
        let open = self.advance()?;
        let mut count = 0;
        let mut comma = None;
        loop {
            self.expression(depth + 1)?;
            count += 1;
            match self.token.kind {
                Kind::Comma => comma = comma.or(Some(self.advance()?.start)),
                Kind::Close if self.word() == closing => break,
                Kind::Close => return Err(self.error_here(Reason::Unopened(self.word()))),
                Kind::End => {
                    return Err(self.error_at(open.start, Reason::Unclosed(self.slice(open))));
                }
                _ => return Err(self.error_here(Reason::NoOperator(self.word()))),
            }
        }
        self.advance()?;
        Ok((count, comma.unwrap_or_default()))
    }

    fn emit(&mut self, operation: Operation, token: Token) -> Result<(), FormulaError<'a>> {
        let built = self.builder.operation(operation, token.start);
        self.checked(built, token)
    }

    fn condition(&mut self, operator: Token, chained: bool) -> Result<(), FormulaError<'a>> {
        let built = self.builder.condition(self.slice(operator), chained, operator.start);
        self.checked(built, operator)
    }

    fn check_depth(&self, depth: usize) -> Result<(), FormulaError<'a>> {
        if depth > B::DEPTH {
            return Err(self.error_here(Reason::TooLarge("nested brackets", B::DEPTH)));
        }
        Ok(())
    }

    fn checked(&self, built: Result<(), Reason<'a>>, token: Token) -> Result<(), FormulaError<'a>> {
        built.map_err(|reason| self.error_at(token.start, reason))
    }

    fn word(&self) -> &'a str {
        self.slice(self.token)
    }

    fn slice(&self, token: Token) -> &'a str {
        self.text.get(token.start..token.end).unwrap_or_default()
    }

    fn error_here(&self, reason: Reason<'a>) -> FormulaError<'a> {
        self.error_at(self.token.start, reason)
    }

    fn error_at(&self, byte: usize, reason: Reason<'a>) -> FormulaError<'a> {
        FormulaError::at(self.text, byte, reason)
    }

    /// Reads the next token; returns the one before it.
    fn advance(&mut self) -> Result<Token, FormulaError<'a>> {
        let before = self.token;
        self.token = token_at(self.text, before.end, B::CONDITIONS)?;
        Ok(before)
    }
}
