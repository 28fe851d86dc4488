import { mountPage } from "@shared/ui/Page";
import { translations } from "./i18n";
import { Tablet } from "./Tablet";
import "./tablet.css";

mountPage({ translations, children: <Tablet /> });
