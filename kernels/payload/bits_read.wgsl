// Module behind `role/voxels` of the payload `bits`.

import lib/is_filled;
