//! Deflate for rows of differences (RFC 1951): literals and runs of zeros, each block with codes of its own.

use crate::huffman::{Code, Huffman};

/// Literals, the end of a block, and lengths of runs.
const SYMBOLS: usize = 286;

/// The symbol after the last.
const END: usize = 256;

/// Shortest and longest run.
const SHORTEST: usize = 3;
const LONGEST: usize = 258;

/// Longest code: four and what is left of a byte fit into 64 bits.
const MOST: u8 = 12;

/// Room, in bytes, for the table of codes, the empty block, and the eight that are written at a time.
const HEAD: usize = 512;

/// Symbols that tell the lengths of codes, in the order in which they are told.
const TOLD: [usize; 19] = [
    16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15,
];

/// Symbol of each length of a run, the number of bits that follow it, and these bits.
const RUNS: [(u16, u8, u8); LONGEST + 1] = runs();

const fn runs() -> [(u16, u8, u8); LONGEST + 1] {
    let mut table = [(0, 0, 0); LONGEST + 1];
    let (mut symbol, mut length) = (257, SHORTEST);
    // From symbol 265 on, every four symbols take another bit.
    let (mut more, mut left) = (0, 8);
    while length < LONGEST {
        let mut rest = 0;
        while rest < 1 << more && length < LONGEST {
            table[length] = (symbol, more, rest);
            length += 1;
            rest += 1;
        }
        symbol += 1;
        left -= 1;
        if left == 0 {
            more += 1;
            left = 4;
        }
    }
    table[LONGEST] = (285, 0, 0);
    table
}

/// Packs blocks of bytes; its memory goes from block to block.
#[derive(Clone, Debug, Default)]
pub(crate) struct Deflater {
    huffman: Huffman,
    stretches: Vec<Stretch>,
    told: Vec<Told>,
    out: Vec<u8>,
}

/// Bytes that are written as they are, and the zeros after them.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    literals: usize,
    zeros: usize,
}

/// A symbol of the table of codes, the number of bits that follow it, and these bits.
type Told = (u8, u8, u8);

/// What bytes are taken for.
trait Tokens {
    /// Eight literals.
    fn eight(&mut self, bytes: [u8; 8]);
    fn literal(&mut self, byte: u8);
    /// The byte before, which is zero, so many times again.
    fn run(&mut self, length: usize);
}

/// Cuts bytes into literals followed by zeros; zeros are worth it where eight stand together.
fn cut(bytes: &[u8], stretches: &mut Vec<Stretch>) {
    stretches.clear();
    let mut rest = bytes;
    while !rest.is_empty() {
        let (eights, odd) = rest.as_chunks::<8>();
        let found = eights.iter().position(|&eight| eight == [0; 8]);
        let literals = found.map_or(8 * eights.len() + odd.len(), |eights| 8 * eights);
        let zeros = zeros(&rest[literals..]);
        stretches.push(Stretch { literals, zeros });
        rest = &rest[literals + zeros..];
    }
}

/// Hands over the tokens of bytes that were cut.
#[inline]
fn each_token(bytes: &[u8], stretches: &[Stretch], tokens: &mut impl Tokens) {
    let mut rest = bytes;
    for &Stretch { literals, zeros } in stretches {
        let (written, after) = rest.split_at(literals);
        let (eights, odd) = written.as_chunks();
        for &eight in eights {
            tokens.eight(eight);
        }
        for &byte in odd {
            tokens.literal(byte);
        }
        rest = &after[zeros..];
        let mut left = zeros;
        if left > 0 && written.last() != Some(&0) {
            tokens.literal(0);
            left -= 1;
        }
        while left >= SHORTEST {
            let one = left.min(LONGEST);
            tokens.run(one);
            left -= one;
        }
        for _ in 0..left {
            tokens.literal(0);
        }
    }
}

/// How many zeros stand at the beginning.
fn zeros(bytes: &[u8]) -> usize {
    let (chunks, _) = bytes.as_chunks::<32>();
    let is_zero = |chunk: &&[u8; 32]| {
        let (words, _) = chunk.as_chunks();
        words
            .iter()
            .fold(0, |all, &word| all | u64::from_le_bytes(word))
            == 0
    };
    let whole = 32 * chunks.iter().take_while(is_zero).count();
    let (words, _) = bytes[whole..].as_chunks();
    let mut count = whole;
    for &word in words {
        let word = u64::from_le_bytes(word);
        if word != 0 {
            return count + word.trailing_zeros() as usize / 8;
        }
        count += 8;
    }
    count + bytes[count..].iter().take_while(|&&byte| byte == 0).count()
}

/// The last block, which is empty, in fixed codes: 1, 01 and 0000000.
pub(crate) const LAST: [u8; 2] = [0x03, 0x00];

/// How often each symbol occurs; neighbours are counted apart, so that none waits for the other.
struct Counts {
    literals: [[u32; 256]; 4],
    runs: [u32; SYMBOLS - END],
}

impl Counts {
    fn sum(&self) -> [u32; SYMBOLS] {
        let mut all = [0; SYMBOLS];
        for part in &self.literals {
            for (sum, count) in all.iter_mut().zip(part) {
                *sum += count;
            }
        }
        all[END..].copy_from_slice(&self.runs);
        all[END] = 1;
        all
    }
}

impl Tokens for Counts {
    #[inline]
    fn eight(&mut self, bytes: [u8; 8]) {
        let [a, b, c, d, e, f, g, h] = bytes.map(usize::from);
        self.literals[0][a] += 1;
        self.literals[1][b] += 1;
        self.literals[2][c] += 1;
        self.literals[3][d] += 1;
        self.literals[0][e] += 1;
        self.literals[1][f] += 1;
        self.literals[2][g] += 1;
        self.literals[3][h] += 1;
    }

    fn literal(&mut self, byte: u8) {
        self.literals[0][usize::from(byte)] += 1;
    }

    fn run(&mut self, length: usize) {
        self.runs[usize::from(RUNS[length].0) - END] += 1;
    }
}

/// Bits, the first in the lowest place of a byte.
struct Bits<'a> {
    out: &'a mut [u8],
    at: usize,
    bits: u64,
    count: u32,
}

impl Bits<'_> {
    /// Adds bits; with those that wait they are at most 64.
    #[inline]
    fn add(&mut self, bits: u64, count: u32) {
        self.bits |= bits << self.count;
        self.count += count;
    }

    /// Lets whole bytes go; at most 7 bits stay.
    #[inline]
    fn flush(&mut self) {
        debug_assert!(
            self.at + 8 <= self.out.len(),
            "the block outgrows its room of {} bytes",
            self.out.len()
        );
        if let Some(place) = self.out[self.at..].first_chunk_mut() {
            *place = self.bits.to_le_bytes();
        }
        self.at += (self.count / 8) as usize;
        self.bits >>= self.count & !7;
        self.count &= 7;
    }

    #[inline]
    fn code(&mut self, code: Code) {
        self.add(u64::from(code.bits), u32::from(code.length));
    }
}

/// Tokens to bits.
struct Written<'a, 'b> {
    codes: &'a [Code; SYMBOLS],
    bits: &'a mut Bits<'b>,
}

impl Tokens for Written<'_, '_> {
    #[inline]
    fn eight(&mut self, bytes: [u8; 8]) {
        let [a, b, c, d, e, f, g, h] = bytes.map(|byte| self.codes[usize::from(byte)]);
        for four in [[a, b, c, d], [e, f, g, h]] {
            for code in four {
                self.bits.code(code);
            }
            self.bits.flush();
        }
    }

    fn literal(&mut self, byte: u8) {
        self.bits.code(self.codes[usize::from(byte)]);
        self.bits.flush();
    }

    fn run(&mut self, length: usize) {
        let (symbol, more, rest) = RUNS[length];
        self.bits.code(self.codes[usize::from(symbol)]);
        self.bits.add(u64::from(rest), u32::from(more));
        // Distance 1, the only one, takes one bit.
        self.bits.add(0, 1);
        self.bits.flush();
    }
}

impl Deflater {
    /// A block for `bytes`, and an empty one that ends with a byte: blocks made apart can be put together.
    pub(crate) fn block(&mut self, bytes: &[u8]) -> &[u8] {
        cut(bytes, &mut self.stretches);
        let mut counts = Counts {
            literals: [[0; 256]; 4],
            runs: [0; SYMBOLS - END],
        };
        each_token(bytes, &self.stretches, &mut counts);
        let mut codes = [Code::default(); SYMBOLS];
        self.huffman.codes(&counts.sum(), MOST, &mut codes);

        let mut out = core::mem::take(&mut self.out);
        let room = bytes.len() * usize::from(MOST) / 8 + HEAD;
        if out.len() < room {
            out.resize(room, 0);
        }
        let mut bits = Bits {
            out: &mut out,
            at: 0,
            bits: 0,
            count: 0,
        };
        // Not the last block; codes of its own.
        bits.add(0b100, 3);
        self.tell(&codes, &mut bits);
        let mut written = Written {
            codes: &codes,
            bits: &mut bits,
        };
        each_token(bytes, &self.stretches, &mut written);
        bits.code(codes[END]);
        // Not the last block; stored, from the next byte on; no bytes, and the complement of their number.
        bits.add(0b000, 3);
        bits.count = bits.count.next_multiple_of(8);
        bits.flush();
        bits.add(0xFFFF_0000, 32);
        bits.flush();
        let end = bits.at;
        self.out = out;
        &self.out[..end]
    }

    /// Writes down the lengths of codes: of literals and runs, and of the only distance.
    fn tell(&mut self, codes: &[Code; SYMBOLS], bits: &mut Bits<'_>) {
        let used = codes
            .iter()
            .rposition(|code| code.length > 0)
            .map_or(0, |last| last + 1);
        let lengths = codes[..used].iter().map(|code| code.length);
        self.told.clear();
        tell_lengths(lengths.chain([1]), &mut self.told);
        let mut counts = [0; TOLD.len()];
        for &(symbol, ..) in &self.told {
            counts[usize::from(symbol)] += 1;
        }
        let mut names = [Code::default(); TOLD.len()];
        self.huffman.codes(&counts, 7, &mut names);
        let named = TOLD
            .iter()
            .rposition(|&symbol| names[symbol].length > 0)
            .map_or(4, |last| (last + 1).max(4));
        bits.add((used - 257) as u64, 5);
        bits.add(0, 5);
        bits.add((named - 4) as u64, 4);
        for &symbol in &TOLD[..named] {
            bits.add(u64::from(names[symbol].length), 3);
            bits.flush();
        }
        for &(symbol, more, rest) in &self.told {
            bits.code(names[usize::from(symbol)]);
            bits.add(u64::from(rest), u32::from(more));
            bits.flush();
        }
    }
}

/// Lengths of codes as symbols, each with some bits more: what repeats is told once.
fn tell_lengths(lengths: impl Iterator<Item = u8>, told: &mut Vec<Told>) {
    let mut lengths = lengths.peekable();
    while let Some(length) = lengths.next() {
        let mut times = 1_u8;
        let most = if length == 0 { 138 } else { 7 };
        while times < most && lengths.next_if_eq(&length).is_some() {
            times += 1;
        }
        match (length, times) {
            (0, 11..) => told.push((18, 7, times - 11)),
            (0, 3..) => told.push((17, 3, times - 3)),
            // The first, then the same again 3 to 6 times.
            (_, 4..) if length > 0 => told.extend([(length, 0, 0), (16, 2, times - 4)]),
            _ => told.extend((0..times).map(|_| (length, 0, 0))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "outgrows its room of 9 bytes")]
    fn a_block_without_room_is_no_silent_damage() {
        let mut bits = Bits {
            out: &mut [0; 9],
            at: 0,
            bits: 0,
            count: 0,
        };
        for _ in 0..3 {
            bits.add(0xAB, 8);
            bits.flush();
        }
    }

    #[test]
    fn lengths_have_the_symbols_of_the_table() {
        // RFC 1951, section 3.2.5.
        for (length, symbol, more, rest) in [
            (3, 257, 0, 0),
            (10, 264, 0, 0),
            (11, 265, 1, 0),
            (12, 265, 1, 1),
            (18, 268, 1, 1),
            (19, 269, 2, 0),
            (66, 276, 3, 7),
            (67, 277, 4, 0),
            (130, 280, 4, 15),
            (131, 281, 5, 0),
            (257, 284, 5, 30),
            (258, 285, 0, 0),
        ] {
            assert_eq!(RUNS[length], (symbol, more, rest), "{length}");
        }
    }

    #[test]
    fn a_block_of_nothing_new_is_short() {
        let mut deflater = Deflater::default();
        let noise: Vec<u8> = (0..4000_u32).map(|i| (i * i / 7) as u8).collect();
        let first = deflater.block(&noise).to_vec();
        assert!(deflater.block(&[0; 38_416]).len() < 80);
        assert_eq!(
            deflater.block(&noise),
            first,
            "what came before leaves no trace"
        );
        assert!(first.len() < 4000 + HEAD);
    }
}
