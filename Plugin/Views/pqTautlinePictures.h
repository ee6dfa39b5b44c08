// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlinePictures
 * @brief Shows images in their colors, behind a mesh found in them, and regions by name.
 *
 * When the output of Match Shape or Silhouette to Mesh is shown for the first time, its image is
 * also shown, in the gray values or colors of its pixels and slightly behind the mesh, which is
 * translucent. The sheet of Shape Retrieval and a list of silhouettes are shown in their colors,
 * without a legend. A domain and its interaction layer have the colors and names of categories
 * (RegionLegend.h). Only the displays are changed, not the data; displays of a loaded state remain
 * unchanged. The plugin starts the object in the GUI.
 */

#ifndef pqTautlinePictures_h
#define pqTautlinePictures_h

#include <QObject>

class pqDataRepresentation;
class pqRepresentation;

class pqTautlinePictures : public QObject
{
  Q_OBJECT

public:
  ///@{
  /// Called by ParaView when the plugin is loaded in the GUI, and before it is unloaded.
  void startup();
  void shutdown();
  ///@}

private Q_SLOTS:
  void added(pqRepresentation* shown);

private:
  void arrange(pqDataRepresentation* mesh);
};

#endif
