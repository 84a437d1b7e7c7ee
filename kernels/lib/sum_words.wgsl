// Where a voxel's sums lie in `sums`: word 0 of each voxel's is the sum of the weights of its fragments, then come three
// words for each attribute, in fixed point (lib/fixed). Emission is there only where the scene emits.

const SUM_ALBEDO: u32 = 1u;
const SUM_NORMAL: u32 = 4u;
/// Position within the voxel.
const SUM_WITHIN: u32 = 7u;
/// In units of the scene's greatest emission.
const SUM_EMISSION: u32 = 10u;

/// Of one voxel.
@if(scene.emissive)
const SUM_WORDS: u32 = 13u;
@else
const SUM_WORDS: u32 = 10u;
