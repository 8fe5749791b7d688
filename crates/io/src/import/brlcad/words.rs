//! Tcl lists, as far as such files have them: a statement a line, braces around what belongs together.
//!
//! ```text
//!   put box arb8 V1 {0 0 0} \n      words: put | box | arb8 | V1 | 0 0 0       braces may hold line ends
//! ```

use super::Fault;

/// A statement: its words without their braces, at least one.
#[derive(Debug)]
pub(super) struct Statement<'a> {
    pub line: usize,
    pub words: Vec<&'a str>,
}

/// All statements.
pub(super) fn statements(text: &str) -> Result<Vec<Statement<'_>>, Fault> {
    let (mut all, mut words) = (Vec::new(), Vec::new());
    let (mut line, mut first) = (1, 1);
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        match bytes[at] {
            b'\n' | b';' => {
                if !words.is_empty() {
                    all.push(Statement { line: first, words: std::mem::take(&mut words) });
                }
                line += usize::from(bytes[at] == b'\n');
                at += 1;
            }
            b'\\' if bytes.get(at + 1) == Some(&b'\n') => {
                line += 1;
                at += 2;
            }
            b' ' | b'\t' | b'\r' => at += 1,
            b'#' if words.is_empty() => at += text[at..].find('\n').unwrap_or(text.len() - at),
            open => {
                if words.is_empty() {
                    first = line;
                }
                let start = at;
                at = match open {
                    b'{' => braced(bytes, at),
                    b'"' => text[at + 1..].find('"').map(|n| at + n + 2),
                    _ => Some(text[at..].find([' ', '\t', '\r', '\n', ';']).map_or(text.len(), |n| at + n)),
                }
                .ok_or_else(|| Fault::new(line, "a brace or quote does not close"))?;
                let inner = if matches!(open, b'{' | b'"') { &text[start + 1..at - 1] } else { &text[start..at] };
                line += inner.matches('\n').count();
                words.push(inner);
            }
        }
    }
    if !words.is_empty() {
        all.push(Statement { line: first, words });
    }
    Ok(all)
}

/// The place after the brace that closes the one at `at`.
fn braced(bytes: &[u8], at: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (i, b) in bytes.iter().enumerate().skip(at) {
        match b {
            b'{' => depth += 1,
            b'}' if depth == 1 => return Some(i + 1),
            b'}' => depth -= 1,
            _ => {}
        }
    }
    None
}
