// Module of the role `payload`: voxels are filled or not, and no more. Costs as lib/mark.

import lib/fill;
import lib/no_attributes;

var<storage, read_write> filled: array<atomic<u32>>;
