// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineBadElements
 * @brief Shows the bad elements inside a mesh: the mesh around them becomes translucent.
 *
 * Element Quality has an output with the bad elements of a volume mesh. This object, started by the
 * plugin in the GUI, draws it with the mesh. It makes the mesh translucent if there are such
 * elements, and opaque again if there are none or the output is switched off. An opacity set by the
 * user is kept. The output Worst is drawn as spheres, also in a translucent mesh. With criteria,
 * the legend of the mesh has labels at their limits. The sections of Solve PDE are shown in the
 * same way.
 *
 * The edges of curved cells are subdivided so that they look curved (unless the user has changed
 * Nonlinear Subdivision Level). If such a mesh has bad elements, Worst is also shown: its spheres
 * mark the smallest Jacobian determinants.
 */

#ifndef pqTautlineBadElements_h
#define pqTautlineBadElements_h

#include <QObject>

class pqDataRepresentation;
class pqPipelineSource;

class pqTautlineBadElements : public QObject
{
  Q_OBJECT

public:
  ///@{
  /// Called by ParaView when the plugin is loaded in the GUI, and before it is unloaded.
  void startup();
  void shutdown();
  ///@}

private Q_SLOTS:
  void dataUpdated(pqPipelineSource* source);
  void arrangeLater(pqPipelineSource* source);

private:
  void arrange(pqPipelineSource* source);
  void fade(pqDataRepresentation* mesh, pqDataRepresentation* inside);
  void restore(pqDataRepresentation* mesh);
};

#endif
