//! Objects of an archive, from the place where the decoder says that one begins.
//!
//! ```text
//!   object record ─▶ class ─▶ its id, its data            a chunk: code, length, content; a short one has no content
//!                             ╰─▶ numbers, arrays, classes within
//! ```
//!
//! Source: `opennurbs_3dm.h` and `opennurbs_archive.cpp` of openNURBS.

use glam::DVec3;

/// Codes of chunks.
const SHORT: u32 = 0x8000_0000;
const WITH_CRC: u32 = 0x8000;
const OBJECT: u32 = 0x2000_8070;
const CLASS: u32 = 0x0002_7FFA;
const CLASS_ID: u32 = 0x0002_FFFB;
const CLASS_DATA: u32 = 0x0002_FFFC;
const ANONYMOUS: u32 = 0x4000_8000;

/// Lengths of chunks have 8 bytes from this version on, 4 before.
const WIDE: u32 = 50;
/// Deepest nesting of classes.
const MAX_DEPTH: u32 = 16;

/// A value, or the name of the part that is missing.
pub(super) type Lost<T> = Result<T, String>;

/// A stretch of an archive that is read from its start on.
#[derive(Clone, Copy)]
pub(super) struct Reader<'b> {
    rest: &'b [u8],
    wide: bool,
    depth: u32,
}

/// A class by the first four bytes of its id, and its data.
pub(super) struct Class<'b> {
    pub id: u32,
    pub data: Reader<'b>,
}

/// The version of an archive, which stands after its name.
pub(super) fn version(bytes: &[u8]) -> Option<u32> {
    std::str::from_utf8(bytes.get(24..32)?).ok()?.trim().parse().ok()
}

/// The class of the object whose record begins at `offset`.
pub(super) fn object(bytes: &[u8], offset: u64) -> Lost<Class<'_>> {
    let version = version(bytes).ok_or("no version of the archive")?;
    let rest = usize::try_from(offset).ok().and_then(|o| bytes.get(o..)).ok_or("no record there")?;
    let mut all = Reader { rest, wide: version >= WIDE, depth: 0 };
    all.chunk(OBJECT)?.class()
}

impl<'b> Reader<'b> {
    fn take(&mut self, count: usize) -> Lost<&'b [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count).ok_or("the data end too early")?;
        self.rest = rest;
        Ok(taken)
    }

    fn bytes<const N: usize>(&mut self) -> Lost<[u8; N]> {
        self.take(N)?.try_into().map_err(|_| "the data end too early".to_owned())
    }

    pub fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    pub fn byte(&mut self) -> Lost<u8> {
        self.bytes::<1>().map(|b| b[0])
    }

    pub fn skip(&mut self, count: usize) -> Lost<()> {
        self.take(count).map(|_| ())
    }

    pub fn int(&mut self) -> Lost<i32> {
        self.bytes().map(i32::from_le_bytes)
    }

    /// A finite number.
    pub fn number(&mut self) -> Lost<f64> {
        let x = self.bytes().map(f64::from_le_bytes)?;
        if x.is_finite() { Ok(x) } else { Err("a coordinate that is no number".to_owned()) }
    }

    pub fn pair(&mut self) -> Lost<[f64; 2]> {
        Ok([self.number()?, self.number()?])
    }

    pub fn point(&mut self) -> Lost<DVec3> {
        Ok(DVec3::new(self.number()?, self.number()?, self.number()?))
    }

    /// A count of things of `each` bytes and more, of which there cannot be more than there are bytes.
    pub fn count(&mut self, each: usize) -> Lost<usize> {
        let count = self.int()?;
        let fits = usize::try_from(count).ok().filter(|n| n.saturating_mul(each) <= self.rest.len());
        fits.ok_or_else(|| format!("a list of {count}"))
    }

    pub fn numbers(&mut self) -> Lost<Vec<f64>> {
        (0..self.count(8)?).map(|_| self.number()).collect()
    }

    pub fn ints(&mut self) -> Lost<Vec<i32>> {
        (0..self.count(4)?).map(|_| self.int()).collect()
    }

    /// Numbers of the major and minor version, both in one byte.
    pub fn version(&mut self) -> Lost<(u8, u8)> {
        self.byte().map(|b| (b >> 4, b & 15))
    }

    /// The next chunk, whatever it is.
    fn next(&mut self) -> Lost<(u32, Self)> {
        let code = self.bytes().map(u32::from_le_bytes)?;
        let value = if self.wide { self.bytes().map(i64::from_le_bytes)? } else { i64::from(self.int()?) };
        if code & SHORT != 0 {
            return Ok((code, Self { rest: &[], ..*self }));
        }
        let length = usize::try_from(value).map_err(|_| "a chunk of negative length")?;
        let content = self.take(length)?;
        let check = if code & WITH_CRC != 0 { 4 } else { 0 };
        let rest = content.get(..length.saturating_sub(check)).unwrap_or_default();
        Ok((code, Self { rest, ..*self }))
    }

    /// The next chunk of a code; others before it are passed over.
    fn chunk(&mut self, wanted: u32) -> Lost<Self> {
        loop {
            let (code, content) = self.next()?;
            if code == wanted {
                return Ok(content);
            }
        }
    }

    /// The next chunk, which has no code of its own.
    pub fn anonymous(&mut self) -> Lost<Self> {
        match self.next()? {
            (ANONYMOUS, content) => Ok(content),
            (code, _) => Err(format!("a chunk of code {code:#x} where one of a list was looked for")),
        }
    }

    /// The next class.
    pub fn class(&mut self) -> Lost<Class<'b>> {
        let mut class = self.chunk(CLASS)?;
        class.depth += 1;
        if class.depth > MAX_DEPTH {
            return Err("classes nested too deep".to_owned());
        }
        let mut id = class.chunk(CLASS_ID)?;
        Ok(Class { id: id.bytes().map(u32::from_le_bytes)?, data: class.chunk(CLASS_DATA)? })
    }
}
