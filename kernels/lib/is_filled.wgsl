// Whether a voxel is filled, where bits are kept in order of the voxels' numbers. Costs as lib/filled_bits.

import lib/filled_bits;
import lib/rows;
