// Lets another program time the cases of a driver one batch at a time, so that the rivals and this library take turns.
//
// Include it before a driver's file. `--serve` lists the cases ("name<tab>units", then an empty line) and then answers
// each line "case calls" with the nanoseconds that these calls took. `--count` runs each case three times for the counter
// of instructions, and prints "name<tab>units". Other arguments do what the driver's own harness does with them.
#pragma once
#define run_benches run_fixed_rounds
#include "bench_common.h"
#undef run_benches

namespace turns {
// The function that the counter of instructions finds by its name, as in the bench of the library.
__attribute__((noinline)) void counted_region(std::function<void()>& op, int calls) {
  for (int i = 0; i < calls; ++i) op();
  asm volatile("" ::: "memory");
}
}  // namespace turns

static int run_benches(int argc, char** argv, const char* tag) {
  bool serves = false, counts = false;
  for (int i = 1; i < argc; ++i) serves |= !strcmp(argv[i], "--serve"), counts |= !strcmp(argv[i], "--count");
  if (counts) {
    for (auto& bench : g_benches) {
      bench.op();
      turns::counted_region(bench.op, 3);
      printf("%s\t%.0f\n", bench.name.c_str(), bench.units * 3);
    }
    return 0;
  }
  if (!serves) return run_fixed_rounds(argc, argv, tag);
  for (auto& bench : g_benches) printf("%s\t%.0f\n", bench.name.c_str(), bench.units);
  printf("\n");
  fflush(stdout);
  unsigned long index = 0, calls = 0;
  while (scanf("%lu %lu", &index, &calls) == 2) {
    if (index >= g_benches.size()) return 1;
    auto& bench = g_benches[index];
    double begin = now_ns();
    for (unsigned long i = 0; i < calls; ++i) bench.op();
    printf("%.0f\n", now_ns() - begin);
    fflush(stdout);
  }
  return 0;
}
