// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RunControl.h
 * @brief Stops a run of a filter of Tautline, in the process of the client or on a server.
 *
 * The filters poll AbortExecute; those that keep their best result so far return it. While one
 * runs, the client processes no events, and a server reads no messages. So the request is
 *
 * - a flag that may be set on any thread, which each poll of a filter in the same process checks;
 * - for a filter on a server, a remote call that the client sends as soon as it learns of the
 *   progress, about once a second. The server looks for it among the bytes that wait in its socket
 *   and leaves them there: it is read, and has no effect, after the run, when its turn comes.
 *   Nothing that the client had sent before is executed within the run.
 *
 * A request holds for the rest of an update of the pipeline: filters that execute after the
 * stopped one stop, too. A server of several processes cannot be stopped.
 */

#ifndef tautline_RunControl_h
#define tautline_RunControl_h

class vtkSMSession;

namespace tautline
{

/// Requests a stop, or withdraws the request. On any thread.
void requestStop(bool stop);
bool isStopRequested();

/// Sends the request to the server of a session; nothing if the data are in this process.
void sendStop(vtkSMSession* session);

} // namespace tautline

#endif
