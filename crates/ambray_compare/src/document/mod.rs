//! A document: what a report says and shows, apart from how it looks.

use std::sync::Arc;

/// A report: one page.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// One or two sentences under the title.
    pub summary: String,
    /// What made it, as pairs of name and value: scene, size, radius, machine, version, command.
    pub facts: Vec<(String, String)>,
    /// Its parts, in order; each is an entry of the table of contents.
    pub sections: Vec<Section>,
}

/// A part of a document.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Its heading.
    pub title: String,
    /// What stands in it.
    pub blocks: Vec<Block>,
}

/// Something in a section.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph of plain text.
    Text(String),
    /// What was measured and whether it agrees with a claim.
    Finding {
        /// What is claimed.
        claim: String,
        /// What was measured.
        measured: String,
        /// Whether the measurement agrees.
        holds: bool,
    },
    /// Pictures of one size, two of which lie over each other with a divider to drag. Both sides can be chosen, and the same
    /// part of both can be seen enlarged.
    Slider {
        /// What is seen.
        caption: String,
        /// All that can be chosen.
        pictures: Vec<Picture>,
        /// Index of the picture left of the divider at first.
        left: usize,
        /// Index of the picture right of the divider at first.
        right: usize,
    },
    /// Pictures side by side, which are enlarged together.
    Gallery {
        /// What is seen.
        caption: String,
        /// The pictures, each with its own caption.
        pictures: Vec<Picture>,
        /// Pictures in a row on a wide page.
        columns: usize,
    },
    /// A table of words and numbers, which can be sorted by each column.
    Table(Table),
    /// A plot of series over logarithmic or linear axes.
    Plot(Plot),
    /// Text to copy, such as a command.
    Command(String),
}

/// A picture of a document.
#[derive(Clone, Debug)]
pub struct Picture {
    /// A short name, also of its file.
    pub name: String,
    /// What is seen, a sentence.
    pub caption: String,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// A complete PNG file.
    pub png: Arc<[u8]>,
}

/// A table.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// What it shows.
    pub caption: String,
    /// Columns, left to right.
    pub columns: Vec<Column>,
    /// Cells, row by row, as many a row as there are columns.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    /// Its heading, with the unit.
    pub title: String,
    /// What the numbers mean, for who points at the heading.
    pub meaning: String,
    /// Which number is the best one of a column, to be marked.
    pub best: Best,
}

/// Which number of a column is the best.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Best {
    /// None is better than another.
    #[default]
    None,
    /// The smallest.
    Smallest,
    /// The largest.
    Largest,
    /// The one nearest to zero.
    NearestZero,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number, shown with so many decimals.
    Number(f64, usize),
    /// Nothing was measured.
    Empty,
}

/// A plot.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// What it shows.
    pub caption: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// The curves.
    pub series: Vec<Series>,
}

/// An axis of a plot.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// Quantity and unit.
    pub title: String,
    /// Whether it is logarithmic; values that are not positive are then left out.
    pub logarithmic: bool,
}

/// A curve, or a single point.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// What it is.
    pub name: String,
    /// Points (x, y) in the order in which they are joined.
    pub points: Vec<(f64, f64)>,
    /// What each point is, for who points at it; as many as points, or none.
    pub labels: Vec<String>,
}

impl Document {
    /// Everything in its sections, in order.
    pub fn blocks(&self) -> impl Iterator<Item = &Block> {
        self.sections.iter().flat_map(|section| &section.blocks)
    }

    /// All its pictures, in the order in which they are seen; one that is seen twice comes twice.
    pub fn pictures(&self) -> impl Iterator<Item = &Picture> {
        self.blocks().flat_map(|block| match block {
            Block::Slider { pictures, .. } | Block::Gallery { pictures, .. } => pictures.as_slice(),
            _ => &[],
        })
    }
}
