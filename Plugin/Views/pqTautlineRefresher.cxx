// SPDX-License-Identifier: BSD-3-Clause
#include "pqTautlineRefresher.h"

#include "ProxyKind.h"

#include "pqApplicationCore.h"
#include "pqPipelineSource.h"
#include "pqServerManagerModel.h"

#include "vtkSMProxy.h"

//------------------------------------------------------------------------------
void pqTautlineRefresher::startup()
{
  QObject::connect(pqApplicationCore::instance()->getServerManagerModel(),
    SIGNAL(dataUpdated(pqPipelineSource*)), this, SLOT(refresh(pqPipelineSource*)));
}

//------------------------------------------------------------------------------
void pqTautlineRefresher::shutdown()
{
  if (pqApplicationCore* core = pqApplicationCore::instance())
  {
    QObject::disconnect(core->getServerManagerModel(), nullptr, this, nullptr);
  }
}

//------------------------------------------------------------------------------
void pqTautlineRefresher::refresh(pqPipelineSource* source)
{
  if (tautline::isTautline(source->getProxy()))
  {
    source->getProxy()->UpdatePropertyInformation();
  }
}
