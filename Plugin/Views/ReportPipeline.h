// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReportPipeline.h
 * @brief The filters of a report, from the reader on, and their settings.
 */

#ifndef tautline_ReportPipeline_h
#define tautline_ReportPipeline_h

#include <QString>
#include <QStringList>

#include <vector>

class pqOutputPort;
class pqPipelineSource;

namespace tautline
{

/// The output that a filter has as its property Input; null for sources and several inputs.
pqOutputPort* inputOf(pqPipelineSource* source);

/// From the reader or source to the filter, along the inputs.
std::vector<pqPipelineSource*> pipelineOf(pqPipelineSource* source);

/// The name of the file that a reader reads, without its directory; "" of other sources.
QString fileOf(pqPipelineSource* source);

/// The properties of the panel whose values are not the default, "Label: value" each.
QStringList changedSettings(pqPipelineSource* source);

} // namespace tautline

#endif
