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

/// The output connected to the property Input of a filter; null for sources and several inputs.
pqOutputPort* inputOf(pqPipelineSource* source);

/// The pipeline from the reader or source to the filter, along the inputs.
std::vector<pqPipelineSource*> pipelineOf(pqPipelineSource* source);

/// The file name of a reader, without its directory; "" for other sources.
QString fileOf(pqPipelineSource* source);

/// The panel properties with values that are not the defaults, each as "Label: value".
QStringList changedSettings(pqPipelineSource* source);

} // namespace tautline

#endif
