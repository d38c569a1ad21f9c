//! Prefix codes of least total length (Huffman 1952), as deflate writes them (RFC 1951, section 3.2.2).

/// Makes codes; its memory goes from one to the next.
#[derive(Clone, Debug, Default)]
pub(crate) struct Huffman {
    /// Symbols that occur, rarest first: how often above [`SYMBOL`] bits, then which.
    order: Vec<usize>,
    weights: Vec<usize>,
}

/// Bits of a symbol in a number that also holds how often it occurs: less than 2^21 times, the bytes of a strip.
const SYMBOL: u32 = 9;

/// A code's bits, the first in the lowest place, and how many they are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Code {
    pub(crate) bits: u16,
    pub(crate) length: u8,
}

impl Huffman {
    /// A code for symbols that occur `counts` times each, none longer than `most` bits; what does not occur gets none.
    ///
    /// 2^`most` is at least the number of symbols.
    pub(crate) fn codes(&mut self, counts: &[u32], most: u8, codes: &mut [Code]) {
        codes.fill(Code::default());
        self.order.clear();
        let occurring = counts.iter().enumerate().filter(|&(_, &count)| count > 0);
        self.order
            .extend(occurring.map(|(symbol, &count)| (count as usize) << SYMBOL | symbol));
        self.order.sort_unstable();
        // How many codes there are of each length.
        let mut numbers = [0_u32; 64];
        self.depths(&mut numbers);
        shorten(&mut numbers, most);
        // The rarest take the longest.
        let mut length = 63;
        for &entry in &self.order {
            while numbers[length] == 0 {
                length -= 1;
            }
            numbers[length] -= 1;
            let symbol = entry & ((1 << SYMBOL) - 1);
            codes[symbol].length = u8::try_from(length).unwrap_or(most);
        }
        number(codes);
    }

    /// Counts the leaves of Huffman's tree at each depth, in the memory of the weights (Moffat and Katajainen 1995).
    fn depths(&mut self, numbers: &mut [u32; 64]) {
        let weights = &mut self.weights;
        weights.clear();
        weights.extend(self.order.iter().map(|&entry| entry >> SYMBOL));
        let count = weights.len();
        if count < 2 {
            numbers[1] = u32::from(count == 1);
            return;
        }
        // Weights of inner nodes, each then replaced by its parent.
        let (mut leaf, mut root) = (0, 0);
        for next in 0..count - 1 {
            let mut take = |weights: &mut [usize]| {
                if leaf >= count || (root < next && weights[root] < weights[leaf]) {
                    let weight = weights[root];
                    weights[root] = next;
                    root += 1;
                    weight
                } else {
                    leaf += 1;
                    weights[leaf - 1]
                }
            };
            let sum = take(weights) + take(weights);
            weights[next] = sum;
        }
        // Depths of inner nodes from the root on, which is the last.
        weights[count - 2] = 0;
        for node in (0..count - 2).rev() {
            weights[node] = weights[weights[node]] + 1;
        }
        // Places at each depth that no inner node takes are leaves.
        let (mut places, mut depth, mut node) = (1_u32, 0, count - 1);
        while places > 0 {
            let mut inner = 0;
            while node > 0 && weights[node - 1] == depth {
                inner += 1;
                node -= 1;
            }
            // Only a tree of more than 2^40 bytes is deeper than 63.
            numbers[depth.min(63)] += places - inner;
            places = 2 * inner;
            depth += 1;
        }
    }
}

/// Makes codes longer than `most` bits that long, and others longer until all fit: the sum of 2^-length is 1 again.
fn shorten(numbers: &mut [u32; 64], most: u8) {
    let most = usize::from(most);
    let long: u32 = numbers[most + 1..].iter().sum();
    if long == 0 {
        return;
    }
    numbers[most + 1..].fill(0);
    numbers[most] += long;
    // In units of the longest code.
    let mut sum: u64 = (1..=most)
        .map(|length| u64::from(numbers[length]) << (most - length))
        .sum();
    while sum > 1 << most {
        // One of the longest joins one that is shorter, below a node in that one's place.
        let Some(shorter) = (1..most).rev().find(|&length| numbers[length] > 0) else {
            debug_assert!(false, "more symbols than there are codes of {most} bits");
            return;
        };
        numbers[most] -= 1;
        numbers[shorter] -= 1;
        numbers[shorter + 1] += 2;
        sum -= 1;
    }
}

/// Numbers the codes in order of length, then of symbol.
fn number(codes: &mut [Code]) {
    let mut next = [0_u16; 16];
    for code in codes.iter() {
        next[usize::from(code.length)] += 1;
    }
    next[0] = 0;
    let mut first = 0;
    for count in &mut next {
        let here = *count;
        *count = first;
        first = (first + here) << 1;
    }
    for code in codes.iter_mut().filter(|code| code.length > 0) {
        let place = &mut next[usize::from(code.length)];
        code.bits = place.reverse_bits() >> (16 - code.length);
        *place += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    #[cfg(debug_assertions)]
    #[should_panic(expected = "more symbols than there are codes of 2 bits")]
    fn more_symbols_than_codes_are_no_silent_damage() {
        let mut numbers = [0; 64];
        numbers[3] = 5;
        shorten(&mut numbers, 2);
    }

    /// Bits that all symbols take together.
    fn total(counts: &[u32], codes: &[Code]) -> u64 {
        let pairs = counts.iter().zip(codes);
        pairs
            .map(|(&count, code)| u64::from(count) * u64::from(code.length))
            .sum()
    }

    /// The same by joining the two rarest until one is left.
    fn least(counts: &[u32]) -> u64 {
        let mut trees: Vec<u64> = counts
            .iter()
            .filter(|&&count| count > 0)
            .map(|&count| u64::from(count))
            .collect();
        let mut total = 0;
        while trees.len() > 1 {
            trees.sort_unstable_by(|a, b| b.cmp(a));
            let joined: u64 = trees.drain(trees.len() - 2..).sum();
            total += joined;
            trees.push(joined);
        }
        total
    }

    fn counts() -> impl Strategy<Value = Vec<u32>> {
        let count = prop_oneof![Just(0), 1..4_u32, (0..30_u32).prop_map(|e| 1 << e)];
        prop::collection::vec(count, 2..286).prop_filter("two that occur", |counts| {
            counts.iter().filter(|&&c| c > 0).count() > 1
        })
    }

    proptest! {
        #[test]
        fn codes_are_whole_short_enough_and_as_short_as_can_be(counts in counts(), most in 9..=15_u8) {
            let mut codes = vec![Code::default(); counts.len()];
            Huffman::default().codes(&counts, most, &mut codes);
            let used: Vec<&Code> = codes.iter().filter(|code| code.length > 0).collect();
            prop_assert!(counts.iter().zip(&codes).all(|(&count, code)| (count > 0) == (code.length > 0)));
            prop_assert!(used.iter().all(|code| code.length <= most));
            let kraft: u64 = used.iter().map(|code| 1 << (most - code.length)).sum();
            prop_assert_eq!(kraft, 1 << most, "every string of bits means something");
            // None begins with another.
            for (i, a) in used.iter().enumerate() {
                for b in &used[i + 1..] {
                    let length = a.length.min(b.length);
                    prop_assert!((a.bits ^ b.bits).trailing_zeros() < u32::from(length));
                }
            }
            let mut free = vec![Code::default(); counts.len()];
            Huffman::default().codes(&counts, 15, &mut free);
            if free.iter().all(|code| code.length < 15) {
                prop_assert_eq!(total(&counts, &free), least(&counts));
            }
        }
    }
}
