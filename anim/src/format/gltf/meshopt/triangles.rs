//! Mode 1, triangles: one code for each triangle, which mostly shares an edge with an earlier one.

use super::stream::{MeshoptFault, MeshoptStream, put_index, unzigzag};

/// The last 16 values, the newest first.
struct Recent<T> {
    values: [T; 16],
    pushed: usize,
}

impl<T: Copy + Default> Recent<T> {
    fn new() -> Self {
        Self { values: [T::default(); 16], pushed: 0 }
    }

    fn push(&mut self, value: T) {
        self.values[self.pushed % 16] = value;
        self.pushed += 1;
    }

    /// Returns the value that was pushed `back` values before the newest one; `back` is 0..15.
    fn get(&self, back: u8) -> Result<T, MeshoptFault> {
        let index = self.pushed.checked_sub(1 + usize::from(back));
        index.map(|index| self.values[index % 16]).ok_or("a triangle refers to one that is not there")
    }
}

/// State between triangles.
struct TriangleReader<'a> {
    extra: MeshoptStream<'a>,
    /// Vertices of the table for triangles with three new corners.
    table: &'a [u8],
    edges: Recent<(u32, u32)>,
    vertices: Recent<u32>,
    next: u32,
    last: u32,
}

/// Decodes indices of `stride` bytes, 2 or 4, until `out` is full; their number is a multiple of 3.
pub(super) fn decode(data: &[u8], stride: usize, out: &mut [u8]) -> Result<(), MeshoptFault> {
    let mut stream = MeshoptStream::new(data);
    if stream.byte()? != 0xe1 {
        return Err("it is no triangles of version 1");
    }
    let codes = stream.take(out.len() / stride / 3)?;
    let table = stream.take_last(16)?;
    if table.iter().any(|entry| entry & 15 == 15 || entry >> 4 == 15) || !table.ends_with(&[0, 0]) {
        return Err("its table is not allowed");
    }
    let mut reader = TriangleReader {
        extra: stream,
        table,
        edges: Recent::new(),
        vertices: Recent::new(),
        next: 0,
        last: 0,
    };
    for (triangle, &code) in out.chunks_exact_mut(stride * 3).zip(codes) {
        let corners = reader.triangle(code)?;
        triangle.chunks_exact_mut(stride).zip(corners).for_each(|(out, corner)| put_index(out, corner));
    }
    reader.extra.finish()
}

impl TriangleReader<'_> {
    fn triangle(&mut self, code: u8) -> Result<[u32; 3], MeshoptFault> {
        match (code >> 4, code & 15) {
            (15, low) => self.new_triangle(low),
            (edge, low) => self.beside_edge(edge, low),
        }
    }

    /// Returns a triangle that shares an edge with an earlier one.
    fn beside_edge(&mut self, edge: u8, low: u8) -> Result<[u32; 3], MeshoptFault> {
        let (a, b) = self.edges.get(edge)?;
        let c = match low {
            0 => self.next(),
            1..=12 => self.vertices.get(low)?,
            13 => self.move_last(1_u32.wrapping_neg()),
            14 => self.move_last(1),
            _ => self.explicit()?,
        };
        if !(1..=12).contains(&low) {
            self.vertices.push(c);
        }
        self.edges.push((c, b));
        self.edges.push((a, c));
        Ok([a, b, c])
    }

    /// Returns a triangle without a known edge.
    fn new_triangle(&mut self, low: u8) -> Result<[u32; 3], MeshoptFault> {
        let is_explicit = low >= 14;
        let entry = match is_explicit {
            true => self.extra.byte()?,
            false => self.table.get(usize::from(low)).copied().unwrap_or_default(),
        };
        if is_explicit && entry == 0 {
            self.next = 0;
        }
        let a = if low == 15 { self.explicit()? } else { self.next() };
        let b = self.corner(entry >> 4)?;
        let c = self.corner(entry & 15)?;
        self.vertices.push(a);
        for (corner, how) in [(b, entry >> 4), (c, entry & 15)] {
            if how == 0 || how == 15 {
                self.vertices.push(corner);
            }
        }
        self.edges.push((b, a));
        self.edges.push((c, b));
        self.edges.push((a, c));
        Ok([a, b, c])
    }

    fn corner(&mut self, how: u8) -> Result<u32, MeshoptFault> {
        match how {
            0 => Ok(self.next()),
            15 => self.explicit(),
            recent => self.vertices.get(recent - 1),
        }
    }

    fn next(&mut self) -> u32 {
        let next = self.next;
        self.next = next.wrapping_add(1);
        next
    }

    fn explicit(&mut self) -> Result<u32, MeshoptFault> {
        let difference = unzigzag(self.extra.number()?);
        Ok(self.move_last(difference))
    }

    fn move_last(&mut self, difference: u32) -> u32 {
        self.last = self.last.wrapping_add(difference);
        self.last
    }
}
