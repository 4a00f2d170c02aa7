// The index or count that stands for none: no photon, no cell, not known yet.
#ifndef PHOTONGRID_INSIDE_KERNEL_STRUCT // core/begin.hpp

const uint NONE = 0xFFFFFFFFu;

#endif
