// The driver of ozz-animation, unchanged, timed in turns.
#include "turns.h"
#include "ozz_bench.cc"
