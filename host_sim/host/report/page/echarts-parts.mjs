// The parts of ECharts that the charts use; the bundler drops all others.

import { BarChart, CustomChart, HeatmapChart, LineChart, ScatterChart } from 'echarts/charts';
import {
  DataZoomInsideComponent, DataZoomSliderComponent, GridComponent, MarkLineComponent, PolarComponent,
  TitleComponent, TooltipComponent, VisualMapContinuousComponent,
} from 'echarts/components';
import { use } from 'echarts/core';
import { SVGRenderer } from 'echarts/renderers';

use([
  BarChart, CustomChart, HeatmapChart, LineChart, ScatterChart, DataZoomInsideComponent, DataZoomSliderComponent,
  GridComponent, MarkLineComponent, PolarComponent, TitleComponent, TooltipComponent, VisualMapContinuousComponent, SVGRenderer,
]);

export { init } from 'echarts/core';
