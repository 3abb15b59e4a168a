//! Files of a magic word and numbers of 32 bits.

use std::{
    fs::File,
    io::{BufReader, Read as _, Write},
    path::Path,
};

use anyhow::{Context as _, bail, ensure};

/// The only version there is.
const VERSION: u32 = 1;

/// A file that is being read. Nothing is allocated for what the file is too short to hold.
#[derive(Debug)]
pub(super) struct Words {
    file: BufReader<File>,
    /// Words that were not read yet.
    left: u64,
}

impl Words {
    /// Opens the file at `path`, which is to begin with `magic` and the version.
    pub(super) fn open(path: &Path, magic: &[u8; 4]) -> anyhow::Result<Self> {
        // Before it is opened: a pipe would wait for somebody to write into it.
        let metadata = std::fs::metadata(path)?;
        ensure!(metadata.is_file(), "is no regular file");
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        let mut file = BufReader::with_capacity(1 << 16, file);
        let mut found = [0; 4];
        let is_whole = file.read_exact(&mut found).is_ok();
        let name = magic.escape_ascii();
        ensure!(is_whole && found == *magic, "is no {name} file: it does not begin with {name}");
        ensure!(length.is_multiple_of(4), "is cut off: its length is no multiple of 4 bytes");
        let mut words = Self { file, left: (length / 4).saturating_sub(1) };
        match words.next()? {
            VERSION => Ok(words),
            other => bail!("has the version {other}, and only {VERSION} is known"),
        }
    }

    /// The next number.
    pub(super) fn next(&mut self) -> anyhow::Result<u32> {
        Ok(self.take(1)?[0])
    }

    /// The next `count` numbers.
    pub(super) fn take(&mut self, count: u64) -> anyhow::Result<Vec<u32>> {
        let left = self.left;
        ensure!(count <= left, "is too short: {count} more numbers should follow, and there are {left}");
        self.left -= count;
        let mut words = Vec::new();
        words.try_reserve_exact(usize::try_from(count)?).context("is too large for the memory")?;
        let mut chunk = [0; 1 << 14];
        while words.len() < count as usize {
            let bytes = &mut chunk[..(4 * (count as usize - words.len())).min(1 << 14)];
            self.file.read_exact(bytes)?;
            words.extend(bytes.as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)));
        }
        Ok(words)
    }

    /// Refuses a file that goes on.
    pub(super) fn end(self) -> anyhow::Result<()> {
        ensure!(self.left == 0, "is too long: {} numbers more than it should have", self.left);
        Ok(())
    }
}

/// Begins a file with `magic` and the version.
pub(super) fn begin(out: &mut (impl Write + ?Sized), magic: &[u8; 4]) -> anyhow::Result<()> {
    out.write_all(magic)?;
    put(out, [VERSION])
}

/// Writes numbers.
pub(super) fn put(
    out: &mut (impl Write + ?Sized),
    words: impl IntoIterator<Item = u32>,
) -> anyhow::Result<()> {
    let mut bytes = Vec::with_capacity(1 << 14);
    for word in words {
        bytes.extend_from_slice(&word.to_le_bytes());
        if bytes.len() == bytes.capacity() {
            out.write_all(&bytes)?;
            bytes.clear();
        }
    }
    Ok(out.write_all(&bytes)?)
}

/// A count as files have it.
pub(super) fn count(length: usize) -> anyhow::Result<u32> {
    u32::try_from(length).context("more than 2^32 entries do not fit into a file")
}
