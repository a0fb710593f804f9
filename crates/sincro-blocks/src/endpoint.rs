//! Ends of wires in text: `block`, `block.port`, `block.port[2]`, `block[0:3]`, `/motor1.position`, `world.q`.

use core::fmt;
use core::ops::Range;

/// End of a wire: a port of a block, of the diagram itself or of the world, or some components of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Endpoint {
    /// Name of the block, or of a port of the diagram itself; [`WORLD`] for a port of the world.
    pub block: String,
    /// Name of the port; empty if the block has only one.
    pub port: String,
    /// Range of components, counted from 0; `None` for all.
    pub range: Option<Range<usize>>,
}

/// Error of [`Endpoint::parse`]: a text that is not an endpoint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EndpointError {
    /// Range of the wrong bytes in the text, counted from 0.
    pub span: Range<usize>,
    /// Description of the error.
    pub message: String,
}

impl fmt::Display for EndpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for EndpointError {}

/// Name of the block that stands for the world in an [`Endpoint`].
pub const WORLD: &str = "world";

impl Endpoint {
    /// Parses an endpoint: `block`, `block.port`, `/path.of.the.world`, each with components as `[2]` or `[0:3]` (end
    /// excluded).
    ///
    /// # Errors
    ///
    /// [`EndpointError`] with the position, if the text has another form.
    ///
    /// # Errors
    ///
    /// If it is none.
    ///
    /// ```
    /// use sincro_blocks::endpoint::Endpoint;
    ///
    /// let end = Endpoint::parse("plant.x[1]").unwrap();
    /// assert_eq!((end.block.as_str(), end.port.as_str(), end.range), ("plant", "x", Some(1..2)));
    /// // what begins with a slash is a port of the world
    /// let end = Endpoint::parse("/arm/motor1.position").unwrap();
    /// assert_eq!((end.block.as_str(), end.port.as_str()), ("world", "/arm/motor1.position"));
    /// assert!(Endpoint::parse("x[").is_err());
    /// ```
    pub fn parse(text: &str) -> Result<Self, EndpointError> {
        let shift = text.len() - text.trim_start().len();
        let body = text.trim();
        let error =
            |span: Range<usize>, message: String| EndpointError { span: span.start + shift..span.end + shift, message };
        let (name, range) = match body.find('[') {
            None => (body, None),
            Some(open) => {
                let Some(inside) = body[open + 1..].strip_suffix(']') else {
                    return Err(error(open..body.len(), "`[` without `]`".into()));
                };
                let parts: Vec<&str> = inside.split(':').map(str::trim).collect();
                let number = |part: &str| part.parse::<usize>().ok();
                let range = match parts[..] {
                    [one] => number(one).filter(|k| *k < usize::MAX).map(|k| k..k + 1),
                    [from, to] => number(from).zip(number(to)).map(|(a, b)| a..b).filter(|r| !r.is_empty()),
                    _ => None,
                };
                match range {
                    Some(range) => (body[..open].trim_end(), Some(range)),
                    None => {
                        let message = format!("`[{inside}]` is no choice of components: write [2] or [0:3]");
                        return Err(error(open..body.len(), message));
                    }
                }
            }
        };
        if name.starts_with('/') {
            return Ok(Self { block: WORLD.into(), port: name.into(), range });
        }
        let (block, port) = name.split_once('.').unwrap_or((name, ""));
        let is_plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-');
        if block.is_empty() || !block.chars().all(is_plain) {
            let message = if name.is_empty() { "nothing stands here".into() } else { format!("`{name}` is no port") };
            return Err(error(0..body.len().max(1), message));
        }
        Ok(Self { block: block.into(), port: port.into(), range })
    }

    /// Parses one endpoint, or several written as `[a, b.y, c]`.
    ///
    /// # Errors
    ///
    /// [`EndpointError`] with the position in `text`, if one of them has another form.
    pub fn parse_list(text: &str) -> Result<Vec<Self>, EndpointError> {
        let trimmed = text.trim();
        let Some(inside) = trimmed.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) else {
            return Self::parse(text).map(|end| vec![end]);
        };
        let mut at = text.find('[').unwrap_or(0) + 1;
        let mut ends = Vec::new();
        for part in inside.split(',') {
            ends.push(Self::parse(part).map_err(|e| EndpointError { span: e.span.start + at..e.span.end + at, ..e })?);
            at += part.len() + 1;
        }
        Ok(ends)
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.block.as_str(), self.port.as_str()) {
            (WORLD, port) if port.starts_with('/') => f.write_str(port)?,
            (block, "") => f.write_str(block)?,
            (block, port) => write!(f, "{block}.{port}")?,
        }
        match &self.range {
            None => Ok(()),
            Some(r) if r.len() == 1 => write!(f, "[{}]", r.start),
            Some(r) => write!(f, "[{}:{}]", r.start, r.end),
        }
    }
}
