// Where it is written which voxels are filled: the buffer `filled` begins with a summary, a bit for each word that
// follows and is not zero; then comes a bit for each voxel, in the payload's order (lib/rows, lib/slices). So what was
// filled is found, and cleared, without a look at the whole grid. (One buffer, since kernels can bind few.)

/// Words of the summary, in a buffer of `length` words: 32 others follow for each.
fn summary_words(length: u32) -> u32 {
    return length / 33u;
}

/// The word that holds a bit.
fn word_of(bit: u32) -> u32 {
    return bit / 32u;
}

/// The bit, alone, in its word.
fn mask_of(bit: u32) -> u32 {
    return 1u << (bit % 32u);
}

/// Takes the lowest bit from a word that has one, and says which it was.
fn take_bit(bits: ptr<function, u32>) -> u32 {
    let bit = firstTrailingBit(*bits);
    *bits &= *bits - 1u;
    return bit;
}
