// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RunControl.h
 * @brief Stops the run of a Tautline filter, in the client process or on a server.
 *
 * The filters poll AbortExecute; iterative filters then return their best result so far. While a
 * filter runs, the client processes no events, and a server reads no messages. The request is thus
 *
 * - a flag, set from any thread and checked by each poll of a filter in the same process;
 * - for a filter on a server, a remote call that the client sends at the next progress message,
 *   about once a second. The server searches the bytes that wait in its socket for it and leaves
 *   them there: the call is read after the run, in its turn, and then has no effect. Earlier
 *   messages from the client are not executed during the run.
 *
 * A request holds for the rest of a pipeline update: filters that execute after the stopped one
 * also stop. A run on several server processes cannot be stopped.
 */

#ifndef tautline_RunControl_h
#define tautline_RunControl_h

class vtkSMSession;

namespace tautline
{

/// Requests a stop, or withdraws the request. May be called from any thread.
void requestStop(bool stop);
bool isStopRequested();

/// Sends the request to the server of a session; does nothing if the data are in this process.
void sendStop(vtkSMSession* session);

} // namespace tautline

#endif
