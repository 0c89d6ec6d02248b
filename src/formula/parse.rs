//! From a text to a tree: sums, products, powers, functions and names.

use super::FormulaError;
use std::ops::Range;

/// How deeply parentheses, signs and powers may be nested.
const DEEPEST: usize = 64;

/// A part of a formula, and where it stands.
#[derive(Debug)]
pub(super) struct Tree {
    pub node: Node,
    pub range: Range<usize>,
}

#[derive(Debug)]
pub(super) enum Node {
    Number(f64),
    Name(String),
    Negative(Box<Tree>),
    /// `+`, `-`, `*`, `/` or `^`.
    Two(char, Box<[Tree; 2]>),
    /// A function and its arguments.
    Call(String, Vec<Tree>),
}

/// How long a text may be, in bytes: a tree is as deep as a sum is long, and is walked by recursion.
const LONGEST: usize = 2000;

/// Reads a formula.
pub(super) fn parse(text: &str) -> Result<Tree, FormulaError> {
    if text.len() > LONGEST {
        return Err(FormulaError {
            range: Some(0..text.len()),
            message: format!("the expression has more than {LONGEST} characters"),
            help: "state parts of it as outputs of their own".to_owned(),
        });
    }
    let mut rest = Rest {
        text,
        at: 0,
        depth: 0,
    };
    let tree = rest.sum()?;
    match rest.next() {
        None => Ok(tree),
        Some(_) => Err(rest.unexpected("an operator such as `+` or `*`")),
    }
}

/// What is left of a text.
struct Rest<'t> {
    text: &'t str,
    at: usize,
    depth: usize,
}

impl Rest<'_> {
    /// The next character that is no space.
    fn next(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    /// Passes over a text, if it is the next.
    fn takes(&mut self, wanted: &str) -> bool {
        self.next();
        let is_there = self.text[self.at..].starts_with(wanted);
        if is_there {
            self.at += wanted.len();
        }
        is_there
    }

    fn unexpected(&mut self, expected: &str) -> FormulaError {
        let found = self.next();
        let end = self.at + found.map_or(0, char::len_utf8);
        FormulaError {
            range: Some(self.at..end),
            message: match found {
                Some(found) => format!("`{found}` is not expected here"),
                None => "the expression ends here".to_owned(),
            },
            help: format!("expected {expected}"),
        }
    }

    fn sum(&mut self) -> Result<Tree, FormulaError> {
        let mut tree = self.product()?;
        loop {
            let sign = match self.next() {
                Some(sign @ ('+' | '-')) => sign,
                _ => return Ok(tree),
            };
            self.at += 1;
            tree = two(sign, tree, self.product()?);
        }
    }

    fn product(&mut self) -> Result<Tree, FormulaError> {
        let mut tree = self.signed()?;
        loop {
            self.next();
            let is_power = self.text[self.at..].starts_with("**");
            let sign = match self.next() {
                Some(sign @ ('*' | '/')) if !is_power => sign,
                _ => return Ok(tree),
            };
            self.at += 1;
            tree = two(sign, tree, self.signed()?);
        }
    }

    /// With a sign before it, which binds less than a power: −x^2 is −(x^2).
    fn signed(&mut self) -> Result<Tree, FormulaError> {
        let sign = match self.next() {
            Some(sign @ ('-' | '+')) => sign,
            _ => return self.power(),
        };
        let start = self.at;
        self.at += 1;
        let of = self.nested(Self::signed)?;
        let range = start..of.range.end;
        Ok(match sign {
            '-' => Tree {
                node: Node::Negative(Box::new(of)),
                range,
            },
            _ => of,
        })
    }

    fn power(&mut self) -> Result<Tree, FormulaError> {
        let base = self.atom()?;
        match self.takes("**") || self.takes("^") {
            false => Ok(base),
            true => {
                let exponent = self.nested(Self::signed)?;
                Ok(two('^', base, exponent))
            }
        }
    }

    fn atom(&mut self) -> Result<Tree, FormulaError> {
        let first = self.next();
        let start = self.at;
        let node = match first {
            Some('(') => {
                self.at += 1;
                let inner = self.nested(Self::sum)?;
                self.closes(start)?;
                return Ok(Tree {
                    range: start..self.at,
                    ..inner
                });
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number()?,
            Some(c) if c.is_alphabetic() || c == '_' => self.name()?,
            _ => return Err(self.unexpected("a number, a name or `(`")),
        };
        Ok(Tree {
            node,
            range: start..self.at,
        })
    }

    fn number(&mut self) -> Result<Node, FormulaError> {
        let rest = &self.text.as_bytes()[self.at..];
        let digits = |from: usize| {
            rest[from..]
                .iter()
                .take_while(|c| c.is_ascii_digit())
                .count()
        };
        let mut end = digits(0);
        if rest.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        if matches!(rest.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(rest.get(end + 1), Some(b'+' | b'-')));
            let length = digits((end + 1 + sign).min(rest.len()));
            end += if length > 0 { 1 + sign + length } else { 0 };
        }
        let text = &self.text[self.at..self.at + end];
        let number = text.parse().ok().filter(|x: &f64| x.is_finite());
        let start = self.at;
        self.at += end;
        number.map(Node::Number).ok_or_else(|| FormulaError {
            range: Some(start..start + end),
            message: format!("`{text}` is not a finite number"),
            help: "write a number such as 0.5 or 1e-3".to_owned(),
        })
    }

    fn name(&mut self) -> Result<Node, FormulaError> {
        let rest = &self.text[self.at..];
        let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.'));
        let name = rest[..end.unwrap_or(rest.len())].to_owned();
        self.at += name.len();
        if self.next() != Some('(') {
            return Ok(Node::Name(name));
        }
        let opened = self.at;
        self.at += 1;
        let mut arguments = Vec::new();
        loop {
            arguments.push(self.nested(Self::sum)?);
            if !self.takes(",") {
                break;
            }
        }
        self.closes(opened)?;
        Ok(Node::Call(name, arguments))
    }

    fn closes(&mut self, opened: usize) -> Result<(), FormulaError> {
        if self.takes(")") {
            return Ok(());
        }
        let error = self.unexpected("`)` or an operator");
        Err(match self.next() {
            Some(_) => error,
            None => FormulaError {
                range: Some(opened..opened + 1),
                message: "this parenthesis is not closed".to_owned(),
                help: "add a `)`".to_owned(),
            },
        })
    }

    fn nested(
        &mut self,
        read: impl Fn(&mut Self) -> Result<Tree, FormulaError>,
    ) -> Result<Tree, FormulaError> {
        if self.depth == DEEPEST {
            let range = Some(self.at..self.at + self.next().map_or(0, char::len_utf8));
            return Err(FormulaError {
                range,
                message: format!("more than {DEEPEST} parts are nested here"),
                help: "state a part of it as an output of its own".to_owned(),
            });
        }
        self.depth += 1;
        let tree = read(self);
        self.depth -= 1;
        tree
    }
}

fn two(sign: char, x: Tree, y: Tree) -> Tree {
    Tree {
        range: x.range.start..y.range.end,
        node: Node::Two(sign, Box::new([x, y])),
    }
}
