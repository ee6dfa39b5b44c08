// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Communicator.h
 * @brief The MPI communicator in the public headers.
 */
#ifndef tautline_Communicator_h
#define tautline_Communicator_h

namespace tautline
{
/// A pointer to an MPI_Comm, so that users of the headers need no MPI; null: this process alone.
using Communicator = const void*;
}
#endif
