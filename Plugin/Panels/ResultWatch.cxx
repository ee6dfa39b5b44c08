// SPDX-License-Identifier: BSD-3-Clause
#include "ResultWatch.h"

#include "pqApplicationCore.h"
#include "pqServerManagerModel.h"

#include <QEvent>
#include <QTimer>
#include <QWidget>

#include <utility>

namespace tautline
{

//------------------------------------------------------------------------------
ResultWatch::ResultWatch(QWidget* widget, vtkSMProxy* proxy, std::function<void()> refresh)
  : QObject(widget)
  , Widget(widget)
  , Proxy(proxy)
  , Refresh(std::move(refresh))
{
  auto* model = pqApplicationCore::instance()->getServerManagerModel();
  QObject::connect(model, &pqServerManagerModel::dataUpdated, this, &ResultWatch::dataUpdated);
  widget->installEventFilter(this);
  // A filter that is being made has the state of one that was applied; fetching would execute it.
  this->Source = model->findItem<pqPipelineSource*>(proxy);
  QTimer::singleShot(0, this, &ResultWatch::refreshIfVisible);
}

//------------------------------------------------------------------------------
void ResultWatch::dataUpdated(pqPipelineSource* source)
{
  if (source->getProxy() == this->Proxy)
  {
    this->Source = source;
    this->Stale = true;
    // After the update: fetching updates a pipeline itself.
    QTimer::singleShot(0, this, &ResultWatch::refreshIfVisible);
  }
}

//------------------------------------------------------------------------------
void ResultWatch::refreshIfVisible()
{
  if (this->Stale && this->Widget->isVisible())
  {
    this->Stale = false;
    this->Refresh();
  }
}

//------------------------------------------------------------------------------
bool ResultWatch::eventFilter(QObject* watched, QEvent* event)
{
  if (watched == this->Widget && event->type() == QEvent::Show)
  {
    QTimer::singleShot(0, this, &ResultWatch::refreshIfVisible);
  }
  return this->QObject::eventFilter(watched, event);
}

} // namespace tautline
