// Module behind `role/voxels` of the payload `slices`.

import lib/filled_bits;
import lib/slices;
