// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlinePictures
 * @brief Shows images in their colours, behind a mesh that was found in them, and regions by name.
 *
 * When the output of Match Shape or Silhouette to Mesh is shown for the first time, its image is
 * shown, too, in the grey values or colours of its pixels and a little behind the mesh, which is
 * translucent. The sheet of Shape Retrieval and a list of silhouettes are shown in their colours,
 * without a legend. A domain and its interaction layer have the colours and names of categories
 * (RegionLegend.h). Only the displays are changed, not the data; those of a loaded state stay as
 * they are. The plugin starts the object in the GUI.
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
