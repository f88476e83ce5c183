// The driver of ACL, unchanged, timed in turns.
#include "turns.h"
#include "acl_bench.cc"
