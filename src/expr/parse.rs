//! From the words of an expression to its tree, by binding power.

use super::Value;
use super::token::{Token, tokens};
use crate::problem::{Place, Problem, Source};
use std::ops::Range;

/// How deep a tree can be, so that neither reading, computing nor dropping one can exhaust the stack.
const MAX_DEPTH: u16 = 64;

/// A piece of an expression and its bytes in the source.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub node: Node,
    pub span: Range<usize>,
    depth: u16,
}

#[derive(Clone, Debug)]
pub(super) enum Node {
    Literal(Value),
    Name(String),
    Component(Box<[Tree; 1]>, usize),
    /// `-` or `!`.
    Prefix(&'static str, Box<[Tree; 1]>),
    Infix(&'static str, Box<[Tree; 2]>),
    If(Box<[Tree; 3]>),
    Call(Function, Vec<Tree>),
}

impl Node {
    pub fn children(&self) -> &[Tree] {
        match self {
            Node::Literal(_) | Node::Name(_) => &[],
            Node::Component(of, _) | Node::Prefix(_, of) => &of[..],
            Node::Infix(_, sides) => &sides[..],
            Node::If(pieces) => &pieces[..],
            Node::Call(_, arguments) => arguments,
        }
    }
}

/// A function's name, the fewest and the most arguments that it takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Function {
    pub name: &'static str,
    fewest: usize,
    most: usize,
}

const fn function(name: &'static str, fewest: usize, most: usize) -> Function {
    Function { name, fewest, most }
}

const FUNCTIONS: [Function; 20] = [
    function("abs", 1, 1),
    function("ceil", 1, 1),
    function("clamp", 3, 3),
    function("cos_degrees", 1, 1),
    function("dot", 2, 2),
    function("exp2", 1, 1),
    function("floor", 1, 1),
    function("length", 1, 1),
    function("log2", 1, 1),
    function("max", 2, 16),
    function("max_of", 1, 1),
    function("min", 2, 16),
    function("min_of", 1, 1),
    function("pow", 2, 2),
    function("round", 1, 1),
    function("sin_degrees", 1, 1),
    function("sqrt", 1, 1),
    function("vec2", 1, 2),
    function("vec3", 1, 3),
    function("vec4", 1, 4),
];

const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

/// How tightly an operator between two sides binds.
fn power(symbol: &str) -> Option<u8> {
    Some(match symbol {
        "||" => 1,
        "&&" => 2,
        "==" | "!=" => 3,
        "<" | "<=" | ">" | ">=" => 4,
        "+" | "-" => 5,
        "*" | "/" | "%" => 6,
        _ => return None,
    })
}

pub(super) fn parse(place: &Place) -> Result<Tree, Problem> {
    let mut parser = Parser { source: &place.source, tokens: tokens(place)?, at: 0 };
    if parser.peek() == Token::End {
        return Err(
            Problem::input("expression-syntax", "there is no expression here").at(place, "it is empty")
        );
    }
    let tree = parser.expression(1, 0)?;
    match parser.peek() {
        Token::End => Ok(tree),
        _ => Err(parser.unexpected("an operator or the end")),
    }
}

struct Parser<'a> {
    source: &'a Source,
    tokens: Vec<(Token<'a>, Range<usize>)>,
    at: usize,
}

impl<'a> Parser<'a> {
    fn peek(&self) -> Token<'a> {
        self.tokens[self.at].0
    }

    fn span(&self) -> Range<usize> {
        self.tokens[self.at].1.clone()
    }

    /// Steps over a token; the end is never stepped over.
    fn advance(&mut self) {
        self.at = (self.at + 1).min(self.tokens.len() - 1);
    }

    fn takes(&mut self, symbol: &str) -> bool {
        let found = matches!(self.peek(), Token::Symbol(next) if next == symbol);
        if found {
            self.advance();
        }
        found
    }

    fn unexpected(&self, wanted: &str) -> Problem {
        let span = self.span();
        let found = match &self.source.text()[span.clone()] {
            "" => "the expression ends".to_owned(),
            text => format!("there is `{text}`"),
        };
        Problem::input("expression-syntax", format!("{found} where {wanted} should be"))
            .at(&self.source.at(span), format!("{wanted} should be here"))
    }

    fn too_deep(&self, span: Range<usize>) -> Problem {
        Problem::input("expression-depth", "this expression is nested too deeply")
            .at(&self.source.at(span), format!("more than {MAX_DEPTH} operations inside each other"))
            .help("split it with named values")
    }

    fn tree(&self, node: Node, span: Range<usize>) -> Result<Tree, Problem> {
        let depth = 1 + node.children().iter().map(|child| child.depth).max().unwrap_or(0);
        if depth > MAX_DEPTH {
            return Err(self.too_deep(span));
        }
        Ok(Tree { node, span, depth })
    }

    /// Operators that bind at least as tightly as `least`, and what is between them.
    fn expression(&mut self, least: u8, depth: u16) -> Result<Tree, Problem> {
        let mut left = self.operand(depth)?;
        while let Token::Symbol(symbol) = self.peek() {
            let Some(power) = power(symbol).filter(|power| *power >= least) else { break };
            self.advance();
            let right = self.expression(power + 1, depth + 1)?;
            let span = left.span.start..right.span.end;
            left = self.tree(Node::Infix(symbol, Box::new([left, right])), span)?;
        }
        Ok(left)
    }

    fn operand(&mut self, depth: u16) -> Result<Tree, Problem> {
        let start = self.span();
        if depth >= MAX_DEPTH {
            return Err(self.too_deep(start));
        }
        let token = self.peek();
        let tree = match token {
            Token::Number(number) => self.leaf(Node::Literal(Value::Number(number)))?,
            Token::Text(text) => self.leaf(Node::Literal(Value::Text(text.to_owned())))?,
            Token::Name("true") => self.leaf(Node::Literal(Value::Flag(true)))?,
            Token::Name("false") => self.leaf(Node::Literal(Value::Flag(false)))?,
            Token::Name(name) => {
                self.advance();
                if self.peek() == Token::Symbol("(") {
                    self.call(name, start, depth)?
                } else {
                    return self.name(name, start);
                }
            }
            Token::Symbol(symbol @ ("-" | "!")) => {
                self.advance();
                let of = self.operand(depth + 1)?;
                let span = start.start..of.span.end;
                return self.tree(Node::Prefix(symbol, Box::new([of])), span);
            }
            Token::Symbol("(") => {
                self.advance();
                let mut inner = self.expression(1, depth + 1)?;
                let end = self.span().end;
                if !self.takes(")") {
                    return Err(self.unexpected("`)`").at(&self.source.at(start), "opened here"));
                }
                inner.span = start.start..end;
                inner
            }
            Token::Symbol(_) | Token::End => return Err(self.unexpected("a value")),
        };
        self.components(tree)
    }

    fn leaf(&mut self, node: Node) -> Result<Tree, Problem> {
        let span = self.span();
        self.advance();
        self.tree(node, span)
    }

    /// `position.x` is a component of `position`.
    fn name(&self, name: &str, span: Range<usize>) -> Result<Tree, Problem> {
        let component = name.rsplit_once('.').and_then(|(of, last)| Some((of, component(last)?)));
        let Some((of, index)) = component else { return self.tree(Node::Name(name.to_owned()), span) };
        let inner = self.tree(Node::Name(of.to_owned()), span.start..span.start + of.len())?;
        self.tree(Node::Component(Box::new([inner]), index), span)
    }

    /// `.x` after a parenthesis or a call.
    fn components(&mut self, mut tree: Tree) -> Result<Tree, Problem> {
        while self.takes(".") {
            let Token::Name(name) = self.peek() else { return Err(self.unexpected("`x`, `y`, `z` or `w`")) };
            let Some(index) = component(name) else { return Err(self.unexpected("`x`, `y`, `z` or `w`")) };
            let span = tree.span.start..self.span().end;
            self.advance();
            tree = self.tree(Node::Component(Box::new([tree]), index), span)?;
        }
        Ok(tree)
    }

    fn call(&mut self, name: &str, start: Range<usize>, depth: u16) -> Result<Tree, Problem> {
        self.advance();
        let mut arguments = Vec::new();
        if self.peek() != Token::Symbol(")") {
            arguments.push(self.expression(1, depth + 1)?);
            while self.takes(",") {
                arguments.push(self.expression(1, depth + 1)?);
            }
        }
        let span = start.start..self.span().end;
        if !self.takes(")") {
            return Err(self.unexpected("`,` or `)`"));
        }
        let given = arguments.len();
        let wrong_count = |name: &str, wanted: String| {
            Problem::input("expression-arguments", format!("`{name}` takes {wanted}, not {given}"))
                .at(&self.source.at(span.clone()), "called here")
        };
        if name == "if" {
            let pieces = <[Tree; 3]>::try_from(arguments)
                .map_err(|_| wrong_count("if", "a condition and two values: 3 arguments".to_owned()))?;
            return self.tree(Node::If(Box::new(pieces)), span);
        }
        let Some(function) = FUNCTIONS.iter().find(|function| function.name == name) else {
            let known = FUNCTIONS.iter().map(|function| function.name).chain(["if"]);
            return Err(Problem::input("unknown-function", format!("there is no function `{name}`"))
                .at(&self.source.at(start), "called here")
                .suggest(name, known));
        };
        if !(function.fewest..=function.most).contains(&given) {
            let (fewest, most) = (function.fewest, function.most);
            let plural = if most == 1 { "" } else { "s" };
            return Err(wrong_count(
                name,
                if fewest == most {
                    format!("{fewest} argument{plural}")
                } else {
                    format!("{fewest} to {most} arguments")
                },
            ));
        }
        self.tree(Node::Call(*function, arguments), span)
    }
}

fn component(name: &str) -> Option<usize> {
    COMPONENTS.iter().position(|component| *component == name)
}
