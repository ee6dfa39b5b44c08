// SPDX-License-Identifier: BSD-3-Clause
// Linked under the sanitizers: libraries that MPI loads stay loaded to the end, so that the report
// of a leak and the list of suppressions can name them.

extern "C" __attribute__((visibility("default"))) int dlclose(void*)
{
  return 0;
}
